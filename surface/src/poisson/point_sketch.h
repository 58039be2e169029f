// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <fresco/core/array.h>
#include <fresco/core/point_set.h>
#include <vector>
namespace fresco::poisson {
/// A sample of a stream of points that does not depend on their order: those whose positions have the lowest hash
/// values. Few points are all in it.
class PointSketch {
public:
  /// @param points of the set that are added
  void add(const PointSet& set, const Array<std::uint32_t>& points, int threads);

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
