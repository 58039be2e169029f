// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <fresco/core/camera.h>
#include <fresco/core/require.h>
namespace fresco {
namespace {
/// OPENCV model: radial k1 k2, tangential p1 p2, on the plane z = 1 (Brown 1966).
Eigen::Vector2d distorted(const CameraModel& camera, const Eigen::Vector2d& p)
{
  const double x = p.x(), y = p.y(), r2 = p.squaredNorm();
  const double radial = 1.0 + r2 * (camera.k1 + r2 * camera.k2);
  return {x * radial + 2 * camera.p1 * x * y + camera.p2 * (r2 + 2 * x * x),
          y * radial + 2 * camera.p2 * x * y + camera.p1 * (r2 + 2 * y * y)};
}

Eigen::Matrix2d distortionJacobian(const CameraModel& camera, const Eigen::Vector2d& p)
{
  const double x = p.x(), y = p.y(), r2 = p.squaredNorm();
  const double radial = 1.0 + r2 * (camera.k1 + r2 * camera.k2);
  const double slope = 2 * (camera.k1 + 2 * r2 * camera.k2); // d radial / dx = slope * x
  Eigen::Matrix2d J;
  J << radial + slope * x * x + 2 * camera.p1 * y + 6 * camera.p2 * x,
      slope * x * y + 2 * camera.p1 * x + 2 * camera.p2 * y, slope * x * y + 2 * camera.p2 * y + 2 * camera.p1 * x,
      radial + slope * y * y + 2 * camera.p2 * x + 6 * camera.p1 * y;
  return J;
}
} // namespace

void validateCamera(const CameraModel& camera)
{
  constexpr int most_pixels = 1000000;
  constexpr double least_focal = 1e-3, most = 1e6; // in sides of the image
  const auto& [width, height, fx, fy, cx, cy, k1, k2, p1, p2] = camera;
  require(width >= 1 && height >= 1 && width <= most_pixels && height <= most_pixels, "camera: an image of ", width,
          "x", height, " pixels");
  const double side = std::max(width, height);
  for (const double focal : {fx, fy})
    require(focal >= least_focal * side && focal <= most * side, "camera: a focal length of ", focal, " pixels for ",
            width, "x", height);
  for (const double value : {cx / side, cy / side, k1, k2, p1, p2})
    require(std::abs(value) <= most, "camera: its centre or distortion is not finite or out of range");
}

Eigen::Vector2d project(const CameraModel& camera, const Eigen::Vector3d& point)
{
  const Eigen::Vector2d p = camera.hasDistortion() ? distorted(camera, point.head<2>() / point.z())
                                                   : Eigen::Vector2d(point.head<2>() / point.z());
  return {camera.fx * p.x() + camera.cx, camera.fy * p.y() + camera.cy};
}

Eigen::Vector3d unproject(const CameraModel& camera, const Eigen::Vector2d& pixel)
{
  const Eigen::Vector2d target((pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy);
  Eigen::Vector2d p = target;
  if (camera.hasDistortion())
    for (int step = 0; step < 20; ++step) { // Newton's method converges in 3 to 5 steps on real lenses
      const Eigen::Matrix2d J = distortionJacobian(camera, p);
      const double det = J.determinant();
      if (!(det > 1e-6)) // the model folds over here: no such direction
        break;
      const Eigen::Vector2d change = J.inverse() * (distorted(camera, p) - target);
      p -= change;
      if (change.squaredNorm() < 1e-24)
        break;
    }
  return {p.x(), p.y(), 1.0};
}
} // namespace fresco
