// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <fresco/core/camera.h>
#include <fresco/core/constants.h>
#include <fresco/core/require.h>
namespace fresco {
namespace {
/// The factor of a point by its r^2, and its derivative by r^2.
struct Radial {
  double factor, slope;
};

bool isFisheye(const CameraModel& c)
{
  return c.projection == CameraProjection::fisheye || c.projection == CameraProjection::fisheye_in_turn;
}

/// atan(c r) / (r omega) with c = 2 tan(omega / 2) (Devernay & Faugeras 2001, "Straight lines have to be straight").
Radial radialOfView(double omega, double r2)
{
  const double c = 2 * std::tan(0.5 * omega), x2 = c * c * r2;
  if (x2 < 1e-4) // of the series: exact to 1e-12 there, where differences are not
    return {c / omega * (1 - x2 / 3 + x2 * x2 / 5), c * c * c / omega * (-1.0 / 3 + 2 * x2 / 5 - 3 * x2 * x2 / 7)};
  const double r = std::sqrt(r2), angle = std::atan(c * r);
  return {angle / (r * omega), (c * r / (1 + x2) - angle) / (2 * r * r2 * omega)};
}

/// Polynomial of r^2 (Brown 1966; Kannala & Brandt 2006 for fisheye), or a quotient of two (OpenCV's rational model).
Radial radialOf(const CameraModel& c, double r2)
{
  if (c.omega > 0)
    return radialOfView(c.omega, r2);
  const bool fisheye = isFisheye(c);
  const double k8 = fisheye ? c.k4 : c.r8, k10 = fisheye ? c.k5 : 0, k12 = fisheye ? c.k6 : 0;
  const double above = 1 + r2 * (c.k1 + r2 * (c.k2 + r2 * (c.k3 + r2 * (k8 + r2 * (k10 + r2 * k12)))));
  const double above_slope = c.k1 + r2 * (2 * c.k2 + r2 * (3 * c.k3 + r2 * (4 * k8 + r2 * (5 * k10 + r2 * 6 * k12))));
  if (fisheye)
    return {above, above_slope};
  const double below = 1 + r2 * (c.k4 + r2 * (c.k5 + r2 * c.k6));
  const double below_slope = c.k4 + r2 * (2 * c.k5 + r2 * 3 * c.k6);
  return {above / below, (above_slope * below - above * below_slope) / (below * below)};
}

Eigen::Vector2d distorted(const CameraModel& c, const Eigen::Vector2d& p)
{
  const Eigen::Vector2d bent = p * radialOf(c, p.squaredNorm()).factor;
  const Eigen::Vector2d q = c.projection == CameraProjection::fisheye_in_turn ? bent : p;
  const double x = q.x(), y = q.y(), r2 = q.squaredNorm();
  return {bent.x() + 2 * c.p1 * x * y + c.p2 * (r2 + 2 * x * x) + (c.sx1 + c.sx2 * r2) * r2,
          bent.y() + 2 * c.p2 * x * y + c.p1 * (r2 + 2 * y * y) + (c.sy1 + c.sy2 * r2) * r2};
}

Eigen::Matrix2d distortionJacobian(const CameraModel& c, const Eigen::Vector2d& p)
{
  const auto [radial, slope] = radialOf(c, p.squaredNorm());
  const Eigen::Matrix2d bent = radial * Eigen::Matrix2d::Identity() + 2 * slope * p * p.transpose();
  const bool in_turn = c.projection == CameraProjection::fisheye_in_turn;
  const Eigen::Vector2d q = in_turn ? Eigen::Vector2d(radial * p) : p;
  const double x = q.x(), y = q.y(), r2 = q.squaredNorm();
  const double prism_x = 2 * (c.sx1 + 2 * c.sx2 * r2), prism_y = 2 * (c.sy1 + 2 * c.sy2 * r2);
  Eigen::Matrix2d rest;
  rest << 2 * c.p1 * y + 6 * c.p2 * x + prism_x * x, 2 * c.p1 * x + 2 * c.p2 * y + prism_x * y,
      2 * c.p2 * y + 2 * c.p1 * x + prism_y * x, 2 * c.p2 * x + 6 * c.p1 * y + prism_y * y;
  return in_turn ? Eigen::Matrix2d(bent + rest * bent) : Eigen::Matrix2d(bent + rest);
}

/// What distorted() makes `target` of, by Newton's method: 3 to 5 steps on real lenses.
Eigen::Vector2d undistorted(const CameraModel& camera, const Eigen::Vector2d& target)
{
  Eigen::Vector2d p = target;
  for (int step = 0; step < 20; ++step) {
    const Eigen::Matrix2d J = distortionJacobian(camera, p);
    const double det = J.determinant();
    if (!(det > 1e-6)) // the model folds over here: no such direction
      break;
    const Eigen::Vector2d change = J.inverse() * (distorted(camera, p) - target);
    p -= change;
    if (change.squaredNorm() < 1e-24)
      break;
  }
  return p;
}

/// Place of a point before distortion.
Eigen::Vector2d idealPlace(CameraProjection projection, const Eigen::Vector3d& q)
{
  if (projection == CameraProjection::perspective)
    return q.head<2>() / q.z();
  if (projection == CameraProjection::spherical)
    return {std::atan2(q.x(), q.z()), std::atan2(q.y(), std::hypot(q.x(), q.z()))};
  const double r = q.head<2>().norm();
  return r > 0 ? Eigen::Vector2d(std::atan2(r, q.z()) / r * q.head<2>()) : Eigen::Vector2d::Zero();
}

Eigen::Vector2d placeOf(const CameraModel& camera, const Eigen::Vector2d& pixel)
{
  const double y = (pixel.y() - camera.cy) / camera.fy;
  const Eigen::Vector2d p((pixel.x() - camera.cx - camera.skew * y) / camera.fx, y);
  const bool bent = camera.hasDistortion() && camera.projection != CameraProjection::spherical;
  return bent ? undistorted(camera, p) : p;
}

/// Direction at `angle` from the axis, towards `p` in the picture.
Eigen::Vector3d atAngle(double angle, const Eigen::Vector2d& p)
{
  const Eigen::Vector2d side = p.norm() > 0 ? Eigen::Vector2d(p.normalized() * std::sin(angle)) : p;
  return {side.x(), side.y(), std::cos(angle)};
}
} // namespace

void validateCamera(const CameraModel& camera)
{
  constexpr int most_pixels = 1000000;
  constexpr double least_focal = 1e-3, most = 1e6; // in sides of the image
  const CameraModel& c = camera;
  require(c.width >= 1 && c.height >= 1 && c.width <= most_pixels && c.height <= most_pixels, "camera: an image of ",
          c.width, "x", c.height, " pixels");
  const double side = std::max(c.width, c.height);
  for (const double focal : {c.fx, c.fy})
    require(focal >= least_focal * side && focal <= most * side, "camera: a focal length of ", focal, " pixels for ",
            c.width, "x", c.height);
  for (const double value : {c.cx / side, c.cy / side, c.k1, c.k2, c.k3, c.k4, c.k5, c.k6, c.p1, c.p2, c.sx1, c.sy1,
                             c.sx2, c.sy2, c.r8, c.skew / side})
    require(std::abs(value) <= most, "camera: its centre or distortion is not finite or out of range");
  require(c.omega >= 0 && c.omega < 0.99 * pi, "camera: a field of view of ", c.omega, " radians");
}

CameraModel sphericalCamera(int width, int height)
{
  require(height > 0 && width == 2 * height, "panorama: ", width, "x", height, " pixels, not twice as wide as high");
  CameraModel camera;
  camera.projection = CameraProjection::spherical;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = height / pi;
  camera.cx = 0.5 * width;
  camera.cy = 0.5 * height;
  return camera;
}

Eigen::Vector2d project(const CameraModel& camera, const Eigen::Vector3d& point)
{
  Eigen::Vector2d p = idealPlace(camera.projection, point);
  if (camera.hasDistortion() && camera.projection != CameraProjection::spherical)
    p = distorted(camera, p);
  return {camera.fx * p.x() + camera.skew * p.y() + camera.cx, camera.fy * p.y() + camera.cy};
}

Eigen::Vector3d direction(const CameraModel& camera, const Eigen::Vector2d& pixel)
{
  const Eigen::Vector2d p = placeOf(camera, pixel);
  if (camera.projection == CameraProjection::perspective)
    return p.homogeneous().normalized();
  if (isFisheye(camera))
    return atAngle(p.norm(), p);
  return {std::cos(p.y()) * std::sin(p.x()), std::sin(p.y()), std::cos(p.y()) * std::cos(p.x())};
}

Eigen::Vector3d unproject(const CameraModel& camera, const Eigen::Vector2d& pixel)
{
  require(camera.projection != CameraProjection::spherical, "camera: a panorama has no plane z = 1");
  const Eigen::Vector2d p = placeOf(camera, pixel);
  if (camera.projection == CameraProjection::perspective)
    return p.homogeneous();
  constexpr double widest = 89 * pi / 180; // the plane z = 1 is 57 wide there, and without end a degree on
  const Eigen::Vector3d ray = atAngle(std::min(p.norm(), widest), p);
  return ray / ray.z();
}
} // namespace fresco
