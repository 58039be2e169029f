// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/octree.h"
namespace fresco::poisson {
/// Finds, depth by depth, the bricks that each rank has: its own, and as ghosts those of others that touch its atoms.
class GhostFinder {
public:
  /// @param partition nullptr: there is nothing to find
  GhostFinder(const Partition* partition, int depth);

  /// @param codes in: sorted bricks around own samples; out: own bricks and ghosts, sorted
  void exchangeBricks(int depth, std::vector<std::uint64_t>& codes);

  /// Tells the octree's levels what was found.
  void addTo(Octree& tree) const;

private:
  using Codes = std::vector<std::uint64_t>;
  struct GhostCodes {
    std::vector<Codes> to_rank, from_rank; ///< ghosts there and here, by rank
  };
  Codes takeOwn(int depth, Codes codes) const;
  void markRemoteChildren(BrickLevel& level) const;

  const Partition* partition_;
  std::vector<GhostCodes> levels_; ///< by depth
  Codes all_children_;             ///< codes of all bricks of the first divided depth
};
} // namespace fresco::poisson
