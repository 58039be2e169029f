// SPDX-License-Identifier: BSD-3-Clause
#include "assembly/part_exchange.h"
#include "assembly/cluster_fits.h"
#include <algorithm>
#include <set>
namespace fresco::registration {
namespace {
using Part = std::vector<Index>; // scans, no more than half of a cluster

// Takes parts out of one cluster.
class PartExchange {
public:
  PartExchange(const GraphInput& input, const FreeSpaceJudge& judge, const ClusterFitter& fitter,
               const std::vector<ScanCluster>& clusters, Index at)
      : judge_(judge), fitter_(fitter), cluster_(clusters[at])
  {
    const std::vector<ClusterFits> fits = mapTasks(clusters.size(), input.options.threads, [&](Index k) {
      return k == at ? ClusterFits() : fitter.find(cluster_, clusters[k]);
    });
    for (std::size_t k = 0; k < clusters.size(); ++k)
      for (const ClusterFit& from : fits[k])
        for (const ClusterFit& to : fits[k])
          if (rivals(to, from, judge.unit()) && !fitter.isSame(clusters[k], from.T, to.T, near_tolerances))
            motions_.push_back(to.T * from.T.inverse());
  }

  bool isDoubtful(const Part& listed) const
  {
    const auto [part, rest] = divide(cluster_, listed);
    ClusterFit here; // where it is: T stays the identity
    here.evidence = judge_.judge(rest, part, here.T);
    if (mayBeMoved(rest, part, here.evidence))
      return true;
    const ClusterFits rough = fitter_.rough(rest, part);
    for (const ClusterFit& fit : rough)
      if (fitter_.isSame(part, fit.T, here.T, near_tolerances))
        here.overlap = std::max(here.overlap, fit.overlap);
    for (const ClusterFit& other : fitter_.uncontradicted(rest, part, rough))
      if (!fitter_.isSame(part, other.T, here.T, near_tolerances) && rivals(other, here, judge_.unit()))
        return true;
    return false;
  }

private:
  // How much is confirmed hardly counts: of equal rooms, the wrong one may be seen best.
  bool mayBeMoved(const ScanCluster& rest, const ScanCluster& part, const FreeSpaceEvidence& here) const
  {
    constexpr double least_confirmed = 0.3; // of a scan's points: less, and chance explains it
    return std::any_of(motions_.begin(), motions_.end(), [&](const Eigen::Isometry3d& T) {
      const FreeSpaceEvidence there = judge_.judge(rest, part, T);
      return there.confirmed >= least_confirmed && there.violating <= noise_violation * there.agree &&
             !isContradicted(there) && !contradictsMore(there, here, judge_.unit());
    });
  }

  const FreeSpaceJudge& judge_;
  const ClusterFitter& fitter_;
  const ScanCluster& cluster_;
  IsometryVector motions_; // from one place of another cluster to a second one: from a room to an equal one
};
} // namespace

void partSecondPlaces(const GraphInput& input, const ScanCluster& known, ScanGraph& graph)
{
  const FreeSpaceJudge judge(input.scans);
  const ClusterFitter fitter(input, judge);
  const auto holds = [](const ScanCluster& cluster) { return [&](Index scan) { return contains(cluster, scan); }; };
  std::set<std::pair<std::size_t, Part>> parts; // smallest first
  for (Part part : graph.parts) {
    std::sort(part.begin(), part.end());
    if (std::none_of(part.begin(), part.end(), holds(known)))
      parts.emplace(part.size(), part);
  }
  const std::vector<ScanCluster> before = graph.clusters;
  for (std::size_t c = 0; c < before.size(); ++c) {
    std::vector<Part> own;
    for (const auto& [size, part] : parts)
      if (2 * size <= before[c].scans.size() && std::all_of(part.begin(), part.end(), holds(before[c])))
        own.push_back(part);
    if (own.empty())
      continue;
    const PartExchange exchange(input, judge, fitter, before, c);
    const std::vector<char> doubtful =
        mapTasks(own.size(), input.options.threads, [&](Index p) -> char { return exchange.isDoubtful(own[p]); });
    for (std::size_t p = 0; p < own.size(); ++p) {
      const auto [part, rest] = divide(graph.clusters[c], own[p]); // smaller parts of it may have gone
      if (doubtful[p] && !part.scans.empty() && !rest.scans.empty())
        partCluster(graph.clusters, c, part.scans, {RefusalReason::second_place, rest.scans[0]});
    }
  }
  sortBySize(graph.clusters, known.scans.empty() ? 0 : 1);
}
} // namespace fresco::registration
