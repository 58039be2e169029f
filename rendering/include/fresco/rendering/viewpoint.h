// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/mesh.h>
#include <fresco/core/point_set.h>
#include <string>
#include <vector>
namespace fresco::rendering {
/// Where a picture is taken from; world coordinates (origin included), unit of the model.
struct Viewpoint {
  Eigen::Vector3d eye = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d look = Eigen::Vector3d::Zero(); ///< point in the middle of the picture
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< need not be orthogonal to the line of sight
  double angle = 30;                              ///< vertical opening angle, degrees, 1..170
};

/// How to look at a whole model.
struct Framing {
  Eigen::Vector3d direction{1.0, -1.6, 1.1};     ///< from the model to the eye, any length above 0
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ(); ///< any length above 0
  double angle = 30;                             ///< vertical opening angle, degrees, 1..170
  double aspect = 4.0 / 3.0;                     ///< width / height of the picture, > 0
  double margin = 0.03;                          ///< share of the picture left free at each side, 0..0.4
};

/// The nearest viewpoint in the given direction from which the whole model is in the picture, centred. A few stray
/// points of a point set do not count.
/// @throws std::invalid_argument if the model has no finite vertex or the framing is out of range
Viewpoint frameView(const TriangleMesh& mesh, const Framing& framing = {});
Viewpoint frameView(const PointSet& set, const Framing& framing = {});

/// Directions for Framing by name: corner, front (from -y), back, left (from -x), right, top, bottom, for z up; for
/// another `up` they are turned with it. @throws std::invalid_argument if the name is unknown
Eigen::Vector3d viewDirection(const std::string& name, const Eigen::Vector3d& up = Eigen::Vector3d::UnitZ());

/// The names that viewDirection() knows.
const std::vector<std::string>& viewNames();

/// @throws std::invalid_argument unless all is finite, eye and look differ and the angle is in range
void validateViewpoint(const Viewpoint& view);

/// Right, up and backward (from the model to the eye) as columns: orthonormal. Where `up` is parallel to the line of
/// sight, another axis takes its place.
Eigen::Matrix3d cameraAxes(const Eigen::Vector3d& backward, const Eigen::Vector3d& up);
} // namespace fresco::rendering
