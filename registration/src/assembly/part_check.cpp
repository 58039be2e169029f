// SPDX-License-Identifier: BSD-3-Clause
#include "assembly/part_check.h"
#include <algorithm>
#include <fresco/core/union_find.h>
namespace fresco::registration {
namespace {
// Whether twice as many points contradict a place as may.
bool isContradictedTwice(FreeSpaceEvidence evidence)
{
  evidence.clustered *= 0.5;
  return isContradicted(evidence);
}
} // namespace

// Whether the evidence of another place of a part leaves open which is right. Where clearly more surfaces agree, more of
// what moved is seen as well. Unless a pair is certain of that place, no more may violate there than mixed pixels do.
bool PartCheck::isUndecided(const FreeSpaceEvidence& here, const FreeSpaceEvidence& there, bool certain) const
{
  constexpr double least_agreement = 0.3; // of a scan's points: less, and chance explains it
  constexpr double clearly_more = 1.5;
  if (there.agree < least_agreement)
    return false;
  if (there.agree < clearly_more * here.agree)
    return !isContradicted(there) && (certain || there.violating <= noise_violation * there.agree) &&
           !contradictsMore(there, here, judge_.unit());
  const double more = there.agree / std::max(here.agree, 1.0 / judge_.unit());
  FreeSpaceEvidence as_much = here;
  as_much.violating *= more;
  as_much.clustered *= more;
  return !isContradictedTwice(there) && !contradictsMore(there, as_much, judge_.unit());
}

// Errors of poses add up in large clusters.
bool PartCheck::isMisplaced(const ClusterPart& placed) { return isContradictedTwice(placed.here); }

std::vector<ScanCluster> PartCheck::heldTogether(const ScanCluster& cluster) const
{
  constexpr double least_agreement = 0.1; // of a scan's points: less, and a wrong place has it
  const Index n = cluster.scans.size();
  UnionFind held(n);
  for (Index a = 0; a < n; ++a)
    for (Index b = a + 1; b < n; ++b)
      if (held.root(a) != held.root(b) &&
          judge_.judge(cluster.scans[a], cluster.scans[b], cluster.poses[a].inverse() * cluster.poses[b]).agree >=
              least_agreement)
        held.join(a, b);
  std::map<Index, std::vector<Index>> members; // by the root, the first of them
  for (Index k = 0; k < n; ++k)
    members[held.root(k)].push_back(cluster.scans[k]);
  std::vector<ScanCluster> parts;
  for (const auto& [root, scans] : members)
    parts.push_back(divide(cluster, scans).first);
  return parts;
}

bool PartCheck::fitsElsewhere(const ClusterPart& placed) const
{
  constexpr double least_overlap = 0.15, least_of_one = 0.3; // of two pairs, of one: less, and chance explains it
  constexpr double least_share = 0.25; // of the best overlap here: less, and many scans of one room see it by chance
  const ClusterFits fits = fitter_.rough(placed.rest, placed.part);
  const auto isHere = [&](const ClusterFit& fit) {
    return fitter_.isSame(placed.part, fit.T, Eigen::Isometry3d::Identity(), 3.0);
  };
  double seen_here = 0.0;
  for (const ClusterFit& fit : fits)
    seen_here = isHere(fit) ? std::max(seen_here, fit.overlap) : seen_here;
  for (const ClusterFit& rough : fits) {
    const double least = std::max(rough.pairs < 2 ? least_of_one : least_overlap, least_share * seen_here);
    if (!rough.certain && rough.overlap < least)
      continue;
    if (!isHere(rough) && isUndecided(placed.here, judge_.judge(placed.rest, placed.part, rough.T), rough.certain))
      return true;
  }
  return false;
}

bool PartCheck::isClaimed(const ScanCluster& claimer, const ClusterPart& placed) const
{
  constexpr double least_share = 0.25; // of the surfaces that agree here
  const bool doubtful = isContradicted(placed.here);
  for (const ClusterFit& rough : fitter_.rough(claimer, placed.part, ClusterFitter::Use::contest)) {
    if (!rough.certain && !(doubtful && rough.sound))
      continue;
    const FreeSpaceEvidence there = judge_.judge(claimer, placed.part, rough.T);
    if (there.agree >= least_share * placed.here.agree && isUndecided(placed.here, there, rough.certain) &&
        isContradicted(judge_.judge(placed.rest, claimer, rough.T.inverse())))
      return true;
  }
  return false;
}

bool PartCheck::mayBeMoved(const ClusterPart& placed, const IsometryVector& motions) const
{
  return std::any_of(motions.begin(), motions.end(), [&](const Eigen::Isometry3d& T) {
    return isUndecided(placed.here, judge_.judge(placed.rest, placed.part, T), false);
  });
}
} // namespace fresco::registration
