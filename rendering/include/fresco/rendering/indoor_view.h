// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/rendering/viewpoint.h>
#include <optional>
namespace fresco::rendering {
struct IndoorOptions {
  std::optional<Eigen::Vector3d> up; ///< upright direction, any length above 0; nothing: guessUp()
  double aspect = 4.0 / 3.0;         ///< width / height of the picture, > 0
  int threads = 0;                   ///< 0 = all cores; the result does not depend on it
};

/// A view as a visitor has it: from free space at 0.6 or 0.75 of the room's height, at some distance from all surfaces,
/// into the direction that shows the most of the room. Faces must show their front to the inside; where they do not,
/// both sides count. Nothing if no point with the model around it is found.
/// @throws std::invalid_argument if the mesh is malformed or has no face with an area, or an option is out of range
std::optional<Viewpoint> insideView(const TriangleMesh& mesh, const IndoorOptions& options = {});

/// A view from above at an angle, the whole model in the picture, for PictureOptions::cull_back_faces: the ceiling and
/// the near walls, seen from behind, are left out, and the inside lies open.
/// Of eight directions the one that shows most.
/// @throws as insideView()
Viewpoint aboveView(const TriangleMesh& mesh, const IndoorOptions& options = {});

/// Both of them, in less time.
struct IndoorViews {
  std::optional<Viewpoint> inside;
  Viewpoint above;
};
IndoorViews indoorViews(const TriangleMesh& mesh, const IndoorOptions& options = {});
} // namespace fresco::rendering
