// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "volumetric_octree.h"
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <fresco/common/parallel.h>
#include <vector>
namespace fresco::volumetric {
/// The three nodes on one axis whose quadratic B-spline reaches a coordinate,
/// and the spline's values and slopes there.
struct QuadraticWeights {
  int first;
  std::array<float, 3> value, slope;

  /// @param t coordinate in cells
  explicit QuadraticWeights(float t)
  {
    const float nearest = std::floor(t + 0.5f);
    const float r = t - nearest;
    first = static_cast<int>(nearest) - 1;
    value = {0.5f * (0.5f - r) * (0.5f - r), 0.75f - r * r, 0.5f * (0.5f + r) * (0.5f + r)};
    slope = {r - 0.5f, -2.f * r, r + 0.5f};
  }
};

/// The four nodes on one axis whose cubic B-spline reaches a coordinate, and the spline's values and slopes there.
struct CubicWeights {
  static constexpr std::size_t count = 4;
  int first;
  std::array<float, 4> value, slope;

  /// @param t coordinate in cells
  explicit CubicWeights(float t)
  {
    const float base = std::floor(t);
    const float r = t - base, q = 1.f - r;
    first = static_cast<int>(base) - 1;
    value = {q * q * q / 6.f, 2.f / 3.f - r * r * (1.f - 0.5f * r), 2.f / 3.f - q * q * (1.f - 0.5f * q),
             r * r * r / 6.f};
    slope = {-0.5f * q * q, r * (1.5f * r - 2.f), -q * (1.5f * q - 2.f), 0.5f * r * r};
  }
};

/// Sums over the nodes -1..5 of a brick on each axis, before they are handed to
/// the bricks that hold these nodes.
class SplatBlock {
public:
  static constexpr int side = 7;
  void clear() { data_.fill(0.f); }
  /// @param x, y, z node relative to the brick, -1..5
  float& at(int x, int y, int z) { return data_[static_cast<std::size_t>(x + 1 + side * (y + 1 + side * (z + 1)))]; }
  void addTo(const BrickLevel& level, Index brick, NodeField& field) const
  {
    std::size_t k = 0;
    for (int z = -1; z < side - 1; ++z)
      for (int y = -1; y < side - 1; ++y)
        for (int x = -1; x < side - 1; ++x, ++k)
          if (data_[k] != 0.f)
            if (const NodePlace place = findNode(level, brick, x, y, z); place.brick >= 0)
              field.brick(place.brick)[place.index] += data_[k];
  }

private:
  std::array<float, side * side * side> data_;
};

/// splat(block, brick) for each brick with samples, added to `field`. Bricks of
/// one colour share no node, so the sums do not depend on the number of
/// threads.
/// @param begin see sampleRanges()
template <typename Splat>
void splatBricks(const BrickLevel& level, const std::vector<std::uint32_t>& begin, NodeField& field, int threads,
                 const Splat& splat)
{
  for (const std::vector<BrickRun>& runs : level.colors)
    parallelFor(static_cast<Index>(runs.size()), threads, [&](Index r) {
      const BrickRun run = runs[static_cast<std::size_t>(r)];
      for (int b = run.begin; b < run.end; ++b) {
        if (begin[static_cast<std::size_t>(b)] == begin[static_cast<std::size_t>(b) + 1])
          continue;
        SplatBlock block;
        block.clear();
        splat(block, b);
        block.addTo(level, b, field);
      }
    });
}
} // namespace fresco::volumetric
