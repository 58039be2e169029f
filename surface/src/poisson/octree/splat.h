// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/node_field.h"
#include "poisson/octree/sample_ranges.h"
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fresco/core/parallel.h>
#include <vector>
namespace fresco::poisson {
/// The three nodes on one axis whose quadratic B-spline reaches a coordinate, and the spline's values there.
struct QuadraticWeights {
  int first;
  std::array<float, 3> value;

  /// @param t coordinate in cells
  explicit QuadraticWeights(float t)
  {
    const float nearest = std::floor(t + 0.5f);
    const float r = t - nearest;
    first = static_cast<int>(nearest) - 1;
    value = {0.5f * (0.5f - r) * (0.5f - r), 0.75f - r * r, 0.5f * (0.5f + r) * (0.5f + r)};
  }
};

/// Hat functions averaged over a cell to either side (convolved with a box two cells wide): the four nodes on one axis
/// whose averaged function reaches a coordinate, and its values and derivatives there.
struct BoxWeights {
  static constexpr int count = 4, reach = 1;
  int first;
  std::array<float, count> value, derivative;

  /// @param t coordinate in cells
  explicit BoxWeights(float t)
  {
    const float base = std::floor(t);
    const float r = t - base, q = 1.f - r;
    first = static_cast<int>(base) - 1;
    value = {0.25f * q * q, 0.5f - 0.25f * r * r, 0.5f - 0.25f * q * q, 0.25f * r * r};
    derivative = {-0.5f * q, -0.5f * r, 0.5f * q, 0.5f * r};
  }
};

/// The same averaged twice (convolved with a hat four cells wide): six nodes.
struct TentWeights {
  static constexpr int count = 6, reach = 2;
  int first;
  std::array<float, count> value, derivative;

  /// @param t coordinate in cells
  explicit TentWeights(float t)
  {
    const float base = std::floor(t);
    const float r = t - base, q = 1.f - r;
    const float r3 = r * r * r / 24.f, q3 = q * q * q / 24.f;
    first = static_cast<int>(base) - 2;
    value = {q3, 0.25f * q + r3, 0.5f - 0.25f * r - 2.f * q3, 0.5f - 0.25f * q - 2.f * r3, 0.25f * r + q3, r3};
    derivative = {-0.125f * q * q,       0.125f * r * r - 0.25f, 0.25f * q * q - 0.25f,
                  0.25f - 0.25f * r * r, 0.25f - 0.125f * q * q, 0.125f * r * r};
  }
};

/// Sums at the nodes -reach..4 + reach of a brick on each axis, before the bricks that hold these nodes get them.
template <int reach>
class SplatBlock {
public:
  static constexpr int side = brick_nodes + 2 * reach;
  void clear() { data_.fill(0.f); }
  bool isZero() const
  {
    return std::all_of(data_.begin(), data_.end(), [](float v) { return v == 0.f; });
  }
  /// @param x, y, z node relative to the brick, -reach..4 + reach
  float& at(int x, int y, int z) { return data_[index(x, y, z)]; }
  void addTo(const BrickLevel& level, Index brick, NodeField& field) const
  {
    const Neighbors neighbors = level.neighborsOf(brick);
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const int n = neighbors[offsetIndex(dx, dy, dz)];
          if (n >= 0)
            forEachRow(dx, dy, dz, [&](int x, int y, int z, int count) {
              float* to = field.own(n) + ownIndex(x & 3, y & 3, z & 3);
              const float* from = &data_[index(x, y, z)];
              for (int i = 0; i < count; ++i)
                to[i] += from[i];
            });
          else
            forEachRow(dx, dy, dz, [&](int x, int y, int z, int count) {
              for (int i = 0; i < count; ++i)
                addAlone(level, brick, x + i, y, z, field);
            });
        }
  }

private:
  static int index(int x, int y, int z) { return x + reach + side * (y + reach + side * (z + reach)); }
  static int first(int d) { return d < 0 ? -reach : d * brick_cells; }
  static int last(int d) { return d < 0 ? -1 : d > 0 ? brick_cells + reach : brick_cells - 1; }

  /// visit(x, y, z, count) for the rows of nodes that the brick at an offset holds.
  template <typename Visit>
  static void forEachRow(int dx, int dy, int dz, const Visit& visit)
  {
    for (int z = first(dz); z <= last(dz); ++z)
      for (int y = first(dy); y <= last(dy); ++y)
        visit(first(dx), y, z, last(dx) - first(dx) + 1);
  }

  /// What no brick holds goes to the border beside it: chi is given there, but coarser depths get the sum. Else normals
  /// would not cancel, and empty space would have sources.
  void addAlone(const BrickLevel& level, Index brick, int x, int y, int z, NodeField& field) const
  {
    if (const float value = data_[index(x, y, z)]; value != 0.f) {
      NodePlace place = findNode(level, brick, x, y, z);
      if (std::max(place.own, place.rim) < 0)
        place = findNode(level, brick, std::clamp(x, 0, brick_cells), std::clamp(y, 0, brick_cells),
                         std::clamp(z, 0, brick_cells));
      field.at(place) += value;
    }
  }

  std::array<float, side * side * side> data_;
};

/// splat(block, brick) for each brick with samples, added to `field`. Bricks of one colour share no node, so the sums
/// do not depend on the number of threads.
/// @param samples see sampleRanges()
/// @tparam reach nodes beyond a brick that its samples reach
template <int reach = 1, typename Splat>
void splatBricks(const BrickLevel& level, const SampleRanges& samples, NodeField& field, int threads,
                 const Splat& splat)
{
  for (const std::vector<BrickRun>& runs : level.colors)
    parallelFor(runs.size(), threads, [&](Index r) {
      const BrickRun run = runs[r];
      for (int b = run.begin; b < run.end; ++b) {
        if (samples[b].empty())
          continue;
        SplatBlock<reach> block;
        block.clear();
        splat(block, b);
        block.addTo(level, b, field);
      }
    });
}
} // namespace fresco::poisson
