// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/mesh.h>
namespace fresco {
struct TrimmingOptions {
  float least = 0.f;        ///< value from which on the mesh is kept
  double gap_area = 0.0;    ///< unit of the vertices squared, >= 0: smaller gaps are kept closed
  double island_area = 0.0; ///< smaller islands go
  int rounds = 4;           ///< in which each value becomes the mean of its own and those around, >= 0
  int threads = 0;          ///< 0 = all cores; the result does not depend on it
};

/// The part of a mesh where `values`, smoothed over it, are at least `least`; triangles are cut along the level line.
/// Vertex attributes follow.
/// @param values V, finite
/// @throws std::invalid_argument if there is not one value per vertex
FRESCO_EXPORT TriangleMesh trimMesh(const TriangleMesh& mesh, Eigen::VectorXf values, const TrimmingOptions& options);
} // namespace fresco
