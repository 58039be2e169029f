// SPDX-License-Identifier: BSD-3-Clause
#include "assembly/part_exchange.h"
#include "assembly/cluster_fits.h"
#include <algorithm>
#include <tuple>
namespace fresco::registration {
namespace {
using Part = std::vector<Index>; // scans

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
          if (rivals(to, from, judge.unit()) && !fitter.isSame(clusters[k], from.T, to.T, near))
            motions_.push_back(to.T * from.T.inverse());
  }

  bool isDoubtful(const Part& listed) const
  {
    const Eigen::Isometry3d where_it_is = Eigen::Isometry3d::Identity();
    const auto [part, rest] = divide(cluster_, listed);
    if (part.scans.size() < listed.size() || part.scans.size() > rest.scans.size())
      return false;
    const ClusterFits rough = fitter_.rough(rest, part);
    ClusterFit here;
    here.evidence = judge_.judge(rest, part, where_it_is);
    bool doubtful = mayBeMoved(rest, part, here.evidence);
    for (const ClusterFit& fit : rough)
      if (fitter_.isSame(part, fit.T, where_it_is, near))
        here.overlap = std::max(here.overlap, fit.overlap);
    for (const ClusterFit& other : fitter_.uncontradicted(rest, part, rough))
      doubtful = doubtful || (!fitter_.isSame(part, other.T, where_it_is, near) && rivals(other, here, judge_.unit()));
    return doubtful;
  }

private:
  static constexpr double near = 3.0; // tolerances

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

// Smallest first, each once.
std::vector<Part> sorted(std::vector<Part> parts)
{
  for (Part& part : parts)
    std::sort(part.begin(), part.end());
  std::sort(parts.begin(), parts.end(),
            [](const Part& x, const Part& y) { return std::tuple(x.size(), x) < std::tuple(y.size(), y); });
  parts.erase(std::unique(parts.begin(), parts.end()), parts.end());
  return parts;
}
} // namespace

void partSecondPlaces(const GraphInput& input, const ScanCluster& known, ScanGraph& graph)
{
  const FreeSpaceJudge judge(input.scans);
  const ClusterFitter fitter(input, judge);
  std::vector<Part> parts = sorted(graph.parts);
  removeIf(parts, [&](const Part& part) {
    return std::any_of(part.begin(), part.end(), [&](Index scan) { return contains(known, scan); });
  });
  const std::vector<ScanCluster> before = graph.clusters;
  for (std::size_t c = 0; c < before.size(); ++c) {
    if (before[c].scans.size() < 2)
      continue;
    const PartExchange exchange(input, judge, fitter, before, c);
    const std::vector<char> doubtful =
        mapTasks(parts.size(), input.options.threads, [&](Index p) -> char { return exchange.isDoubtful(parts[p]); });
    for (std::size_t p = 0; p < parts.size(); ++p) {
      auto [part, rest] = divide(graph.clusters[c], parts[p]);
      if (!doubtful[p] || part.scans.empty() || rest.scans.empty())
        continue;
      part.refusal = {RefusalReason::second_place, rest.scans[0]};
      rest.refusal = graph.clusters[c].refusal;
      graph.clusters[c] = rest;
      graph.clusters.push_back(part);
    }
  }
  sortBySize(graph.clusters, known.scans.empty() ? 0 : 1);
}
} // namespace fresco::registration
