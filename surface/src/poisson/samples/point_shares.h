// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/partition.h"
#include "poisson/samples/cube.h"
namespace fresco::poisson {
/// How a reconstruction is divided.
struct RankOptions {
  int shared_depth = Partition::usual_shared_depth;
  std::vector<std::uint64_t> first_atoms; ///< by rank; empty: chosen for an even load
};

/// Whether there is work for more than rank 0.
inline bool isDivided(int depth, const RankOptions& ranks) { return depth > ranks.shared_depth + 1; }

/// Samples in the rank's own atoms, of the points of all ranks.
struct SampleShare {
  Partition partition;
  Samples samples;
};
SampleShare gatherShare(const PointStream& points, const VolumetricOptions& options, const RankOptions& ranks,
                        Exchange& exchange);
} // namespace fresco::poisson
