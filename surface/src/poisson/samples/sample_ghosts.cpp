// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/samples/sample_ghosts.h"
namespace fresco::poisson {
SampleGhosts::SampleGhosts(const Octree& tree, const Array<std::uint64_t>& codes, int threads)
{
  if (!tree.partition)
    return;
  partition_ = tree.partition;
  finest_ = tree.depth;
  runs_.resize(partition_->ranks());
  const BrickLevel& level = tree.levels[partition_->sharedDepth() + 1];
  const SampleRanges ranges = sampleRanges(level, codes, tree.depth, threads);
  for (const Ghosts::Peer& peer : level.ghosts.peers) {
    std::vector<int> bricks = peer.send.bricks;
    std::sort(bricks.begin(), bricks.end());
    for (const int b : bricks)
      if (!ranges[b].empty())
        runs_[peer.rank].push_back(ranges[b]);
  }
}

SampleLevel coarsen(const SampleLevel& fine, const Octree& tree, int threads, const Array<Eigen::Vector3f>* normals)
{
  SampleLevel coarse = coarsen(fine, threads, normals);
  if (!tree.partition || coarse.depth != tree.partition->sharedDepth() + 1)
    return coarse;
  const auto [begin, end] = tree.partition->ownRange(coarse.depth, coarse.codes);
  Exchange& exchange = tree.partition->exchange();
  coarse.codes = gatherAll(exchange, coarse.codes.data() + begin, end - begin);
  coarse.samples = gatherAll(exchange, coarse.samples.data() + begin, end - begin);
  const bool has_fluxes = !coarse.fluxes.empty(); // else others may have some
  coarse.fluxes = gatherAll(exchange, coarse.fluxes.data() + (has_fluxes ? begin : 0), has_fluxes ? end - begin : 0);
  return coarse;
}
} // namespace fresco::poisson
