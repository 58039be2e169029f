// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/camera.h>
namespace fresco {
/// x -> scale R x + t.
struct Similarity {
  double scale = 1; ///< > 0
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();

  Eigen::Vector3d operator*(const Eigen::Vector3d& x) const { return scale * (R * x) + t; }

  Similarity operator*(const Similarity& first) const { return {scale * first.scale, R * first.R, *this * first.t}; }

  Similarity inverse() const { return {1 / scale, R.transpose(), -(R.transpose() * t) / scale}; }

  Eigen::Matrix4d matrix() const
  {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.topLeftCorner<3, 3>() = scale * R;
    matrix.topRightCorner<3, 1>() = t;
    return matrix;
  }
};

/// Brings cameras and points into another frame, in which they show the same photographs.
inline void transformCameras(const Similarity& T, CameraSet& set, SparsePoints& points)
{
  for (View& view : set.views) {
    const Eigen::Vector3d center = T * view.center();
    view.T_camera_world.linear() = view.T_camera_world.linear() * T.R.transpose();
    view.T_camera_world.translation() = -(view.T_camera_world.linear() * center);
  }
  for (SparsePoint& point : points)
    point.position = T * point.position;
}
} // namespace fresco
