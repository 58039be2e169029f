// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "normals/plane_kernels.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <fresco/search/neighborhoods.h>
namespace fresco::filters {
/// Weighted sums over points given as offsets from a point nearby, which keeps single precision exact enough.
struct Moments {
  float weight = 0;
  float sums[9] = {}; ///< x, y, z, xx, xy, xz, yy, yz, zz

  Moments() = default;
  Moments(float all, const float* nine) : weight(all) { std::copy_n(nine, 9, sums); }
  void add(const Eigen::Vector3f& offset, float w = 1)
  {
    const float x = w * offset.x(), y = w * offset.y(), z = w * offset.z();
    const float terms[9] = {
        x, y, z, x * offset.x(), x * offset.y(), x * offset.z(), y * offset.y(), y * offset.z(), z * offset.z()};
    weight += w;
    for (int t = 0; t < 9; ++t)
      sums[t] += terms[t];
  }
};

/// Least squares plane through points, in half a cache line.
struct alignas(32) Plane {
  enum Shape { point, line, plane };
  Eigen::Vector3f normal = Eigen::Vector3f::Zero(); ///< unit; of a line its direction; of coincident points zero
  float variance = 0; ///< mean squared distance, at least what rounding leaves, length^2; infinite: no plane
  Eigen::Vector3f center = Eigen::Vector3f::Zero(); ///< mean of the points
  float curvature = 0;                              ///< share of the smallest of the three variances, 0..1/3; -1 line

  Shape shape() const { return std::isfinite(variance) ? plane : curvature < 0 ? line : point; }
  float distance(const Eigen::Vector3f& other) const { return normal.dot(other - center); }
};
static_assert(sizeof(Plane) == 32, "kernels read planes as rows of 8 numbers");

/// Plane, line or point through the sums. @param origin of the offsets
Plane fitPlane(const Moments& moments, const Eigen::Vector3f& origin);

/// Fits planes eight at a time.
template <typename Use>
class PlaneBatch {
public:
  explicit PlaneBatch(Use use) : use_(std::move(use)) {}
  /// use(i, plane) will be called. @param origin of the offsets
  void add(Index i, const Eigen::Vector3f& origin, const Moments& sums);
  void finish(); ///< after the last

private:
  Use use_;
  EightMoments moments_;
  Eigen::Vector3f origins_[8];
  Index points_[8];
  int count_ = 0;
};

template <typename Use>
void PlaneBatch<Use>::add(Index i, const Eigen::Vector3f& origin, const Moments& sums)
{
  points_[count_] = i;
  origins_[count_] = origin;
  moments_.weight[count_] = sums.weight;
  for (int t = 0; t < 9; ++t)
    moments_.sums[t][count_] = sums.sums[t];
  if (++count_ == 8)
    finish();
}

template <typename Use>
void PlaneBatch<Use>::finish()
{
  EightPlanes fits;
  for (int i = count_; i < 8; ++i) {
    moments_.weight[i] = 0;
    for (auto& sums : moments_.sums)
      sums[i] = 0;
  }
  planeKernels().fit(moments_, fits);
  for (int i = 0; i < count_; ++i) {
    if (fits.planes >> i & 1u) {
      const Eigen::Vector3f offset(fits.center[0][i], fits.center[1][i], fits.center[2][i]);
      use_(points_[i], Plane{{fits.normal[0][i], fits.normal[1][i], fits.normal[2][i]},
                             fits.variance[i],
                             origins_[i] + offset,
                             fits.curvature[i]});
    } else {
      float sums[9];
      for (int t = 0; t < 9; ++t)
        sums[t] = moments_.sums[t][i];
      use_(points_[i], fitPlane({moments_.weight[i], sums}, origins_[i]));
    }
  }
  count_ = 0;
}
} // namespace fresco::filters
