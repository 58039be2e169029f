// SPDX-License-Identifier: BSD-3-Clause
#include "charts/patch_map.h"
#include <Eigen/LU>
#include <cmath>
namespace fresco::texture {
PatchMap::PatchMap(const PatchMesh& patches, Index patch, const Eigen::Matrix<double, 2, 3>& corners,
                   const Eigen::Vector2d& origin)
    : points_(patches.corners(patch).cast<double>())
{
  Eigen::Matrix3d places;
  places.topRows<2>() = corners.colwise() - origin;
  places.row(2).setOnes();
  corners_ = places.topRows<2>().cast<float>();
  bool has_area = false;
  places.computeInverseWithCheck(inverse_, has_area);
  if (!has_area) {
    inverse_.setZero();
    inverse_.col(2).setConstant(1.0 / 3);
  }
  weights_ = inverse_.cast<float>();
}

bool PatchMap::look(const Projector& view)
{
  const CameraModel& c = view.camera();
  Eigen::Matrix3d pixels; // homogeneous, of the corners
  Eigen::Matrix<double, 2, 3> bent;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d q = view.inCamera(points_.col(k).cast<float>()).cast<double>();
    if (!(q.z() > 1e-6))
      return false;
    pixels.col(k) << c.fx * q.x() + c.cx * q.z(), c.fy * q.y() + c.cy * q.z(), q.z();
    bent.col(k).setZero();
    if (c.hasDistortion())
      bent.col(k) = view(points_.col(k).cast<float>()).head<2>().cast<double>() - pixels.col(k).hnormalized();
  }
  camera_ = (pixels * inverse_).cast<float>();
  lens_ = (bent * inverse_).cast<float>();
  return true;
}

Eigen::Matrix<float, 2, 3> PatchMap::cornerPixels() const
{
  Eigen::Matrix<float, 2, 3> pixels;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector2f at = place(Eigen::Vector3f::Unit(k));
    pixels.col(k) = pixel(at.x(), at.y());
  }
  return pixels;
}

Eigen::Matrix2f PatchMap::steps(float x, float y) const
{
  const Eigen::Vector2f at = pixel(x, y);
  Eigen::Matrix2f out;
  out.col(0) = pixel(x + 1, y) - at;
  out.col(1) = pixel(x, y + 1) - at;
  return out;
}

Eigen::Matrix2f PatchMap::middleSteps() const
{
  const Eigen::Vector2f middle = place(Eigen::Vector3f::Constant(1.f / 3));
  return steps(middle.x(), middle.y());
}
} // namespace fresco::texture
