// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <fresco/core/exchange.h>
#include <fresco/core/point_set.h>
#include <functional>
#include <vector>
namespace fresco::poisson {
/// A sample of a stream of points that does not depend on their order: those whose positions have the lowest hash
/// values. Few points are all in it.
class PointSketch {
public:
  /// Adds the points i with takes(i).
  void add(const PointSet& set, const std::function<bool(Index)>& takes, int threads);

  /// Adds those of the other ranks.
  void share(Exchange& exchange);

  /// Coordinates on one axis, in no order.
  std::vector<float> coordinates(int axis) const;

private:
  struct Entry {
    std::uint64_t hash;
    Eigen::Vector3f position;
  };
  void keepLowest();
  std::vector<Entry> entries_;
  std::uint64_t highest_ = ~std::uint64_t(0); ///< hash that an entry may have
};
} // namespace fresco::poisson
