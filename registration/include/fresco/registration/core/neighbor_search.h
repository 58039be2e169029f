// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/search/neighbors.h>
namespace fresco {
/// A caller's own search for nearest neighbours, to be used in place of PointTree.
class FRESCO_EXPORT NeighborSearch {
public:
  virtual ~NeighborSearch() = default;

  /// Points that later searches look in. Never called while a search runs.
  /// @param points 3xN, finite
  virtual void setPoints(const Points& points) = 0;

  /// The k nearest points (fewer if there are fewer), by distance. Searches run in parallel.
  /// @param query finite
  virtual void nearest(const Eigen::Vector3f& query, int k, std::vector<Neighbor>& found) const = 0;
};
} // namespace fresco
