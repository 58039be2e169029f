// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/camera.h>
namespace fresco::texture {
/// A camera at its place, in the mesh's coordinates.
class Projector {
public:
  /// @param origin of the mesh: world = origin + coordinate
  Projector(const CameraModel& camera, const Eigen::Isometry3d& T_camera_world, const Eigen::Vector3d& origin);

  /// Pixel (x, y) and depth z in mesh units. Depth 0: behind the camera, or so far aside that the lens model does not
  /// hold.
  Eigen::Vector3f operator()(const Eigen::Vector3f& point) const;

  /// The point in the camera's frame: x right, y down, z forward.
  Eigen::Vector3f inCamera(const Eigen::Vector3f& point) const { return R_ * point + t_; }

  const CameraModel& camera() const { return camera_; }
  Eigen::Vector3f center() const { return center_; }
  /// Direction in mesh coordinates whose multiple by the depth leads from the centre to what the pixel shows.
  Eigen::Vector3f ray(const Eigen::Vector2d& pixel) const;
  /// Geometric mean of the focal lengths, pixels.
  float focal() const { return focal_; }

private:
  CameraModel camera_;
  Eigen::Matrix3f R_;
  Eigen::Vector3f t_, center_;
  Eigen::Array2d low_, high_; ///< bounds of the image on the plane z = 1, widened
  float focal_;
};
} // namespace fresco::texture
