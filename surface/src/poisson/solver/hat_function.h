// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/octree.h"
#include <Eigen/Core>
#include <cmath>
namespace fresco::poisson {
/// The cell that a position lies in and the values of the hat functions of its corners there (bits of the index:
/// x, y, z).
struct HatWeights {
  int x, y, z;
  float value[8];

  /// @param position in cells
  explicit HatWeights(const Eigen::Vector3f& position)
  {
    x = floorOf(position.x());
    y = floorOf(position.y());
    z = floorOf(position.z());
    const Eigen::Vector3f t = position - Eigen::Vector3f(x, y, z);
    const float wx[2] = {1 - t.x(), t.x()}, wy[2] = {1 - t.y(), t.y()}, wz[2] = {1 - t.z(), t.z()};
    for (int i = 0; i < 8; ++i)
      value[i] = wx[i & 1] * wy[i >> 1 & 1] * wz[i >> 2];
  }

  /// For a position in a brick, in cells from its corner; the upper faces belong to it.
  static HatWeights inBrick(const Eigen::Vector3f& position)
  {
    constexpr float last = brick_cells * (1 - 1e-6f);
    return HatWeights(position.cwiseMax(0.f).cwiseMin(last));
  }

  /// std::floor() without the call of a function.
  /// @param position within the range of int
  static int floorOf(float position)
  {
    const int truncated = static_cast<int>(position);
    return truncated - (position < truncated ? 1 : 0);
  }

  int nodeOf(int corner) const { return nodeIndex(x + (corner & 1), y + (corner >> 1 & 1), z + (corner >> 2)); }

  /// @param value_at of node (x, y, z)
  template <typename ValueAt>
  float interpolateWith(const ValueAt& value_at) const
  {
    float sum = 0;
    for (int i = 0; i < 8; ++i)
      sum += value[i] * value_at(x + (i & 1), y + (i >> 1 & 1), z + (i >> 2));
    return sum;
  }
  float interpolate(const float* nodes) const
  {
    return interpolateWith([nodes](int i, int j, int k) { return nodes[nodeIndex(i, j, k)]; });
  }
};
} // namespace fresco::poisson
