// SPDX-License-Identifier: BSD-3-Clause
#include "photographs/projector.h"
#include <cmath>
#include <limits>
namespace fresco::texture {
Projector::Projector(const CameraModel& camera, const Eigen::Isometry3d& T_camera_world, const Eigen::Vector3d& origin)
    : camera_(camera), R_(T_camera_world.linear().cast<float>()), t_((T_camera_world * origin).cast<float>()),
      center_((-(T_camera_world.linear().transpose() * (T_camera_world * origin))).cast<float>()),
      low_(Eigen::Array2d::Constant(std::numeric_limits<double>::infinity())), high_(-low_),
      focal_(std::sqrt(camera.fx * camera.fy))
{
  constexpr int steps = 16;
  for (int i = 0; i <= steps; ++i) {
    const double x = 1.0 * camera.width * i / steps, y = 1.0 * camera.height * i / steps;
    for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(x, 0), Eigen::Vector2d(x, camera.height),
                                         Eigen::Vector2d(0, y), Eigen::Vector2d(camera.width, y)}) {
      const Eigen::Array2d p = unproject(camera, pixel).head<2>().array();
      low_ = low_.min(p);
      high_ = high_.max(p);
    }
  }
  const Eigen::Array2d spare = 0.1 * (high_ - low_);
  low_ -= spare;
  high_ += spare;
}

Eigen::Vector3f Projector::operator()(const Eigen::Vector3f& point) const
{
  const Eigen::Vector3f q = R_ * point + t_;
  if (!(q.z() > 1e-6f))
    return Eigen::Vector3f::Zero();
  const double z = q.z(), x = q.x() / z, y = q.y() / z;
  if (!camera_.hasDistortion())
    return Eigen::Vector3d(camera_.fx * x + camera_.cx, camera_.fy * y + camera_.cy, z).cast<float>();
  if (x < low_.x() || x > high_.x() || y < low_.y() || y > high_.y())
    return Eigen::Vector3f::Zero();
  const Eigen::Vector2d pixel = project(camera_, {x, y, 1.0});
  return Eigen::Vector3d(pixel.x(), pixel.y(), z).cast<float>();
}

Eigen::Vector3f Projector::ray(const Eigen::Vector2d& pixel) const
{
  return R_.transpose() * unproject(camera_, pixel).cast<float>();
}
} // namespace fresco::texture
