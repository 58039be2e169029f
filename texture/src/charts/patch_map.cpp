// SPDX-License-Identifier: BSD-3-Clause
#include "charts/patch_map.h"
#include <Eigen/LU>
#include <cmath>
namespace fresco::texture {
PatchMap::PatchMap(const PatchMesh& patches, Index patch, const Eigen::Matrix<double, 2, 3>& corners,
                   const Eigen::Vector2d& origin)
{
  for (int k = 0; k < 3; ++k)
    points_.col(k) = patches.vertices.col(patches.faces(k, patch)).cast<double>();
  Eigen::Matrix3d places;
  places.topRows<2>() = corners.colwise() - origin;
  places.row(2).setOnes();
  corners_ = places.topRows<2>().cast<float>();
  inverse_.setZero();
  if (std::abs(places.determinant()) > 1e-12)
    inverse_ = places.inverse();
  else
    inverse_.col(2).setConstant(1.0 / 3);
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

void PatchMap::pixels(const Row& row, float* __restrict u, float* __restrict v) const
{
  const auto [x, y] = std::pair(row.start.x(), row.start.y());
  const Eigen::Vector3f camera = camera_.col(1) * y + camera_.col(2), camera_step = camera_.col(0);
  const Eigen::Vector2f lens = lens_.col(1) * y + lens_.col(2), lens_step = lens_.col(0);
  for (int i = 0; i < row.count; ++i) { // several at a time, by the compiler
    const float at = x + row.step * i, scale = 1 / (camera_step[2] * at + camera[2]);
    u[i] = (camera_step[0] * at + camera[0]) * scale + lens_step[0] * at + lens[0];
    v[i] = (camera_step[1] * at + camera[1]) * scale + lens_step[1] * at + lens[1];
  }
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
} // namespace fresco::texture
