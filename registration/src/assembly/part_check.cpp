// SPDX-License-Identifier: BSD-3-Clause
#include "assembly/part_check.h"
#include <algorithm>
namespace fresco::registration {
// Whether the evidence of another place of a part leaves open which is right. Where clearly more surfaces agree, more of
// what moved is seen as well.
bool PartCheck::isUndecided(const FreeSpaceEvidence& here, const FreeSpaceEvidence& there) const
{
  constexpr double least_agreement = 0.3; // of a scan's points: less, and chance explains it
  constexpr double clearly_more = 1.5;
  if (there.agree < least_agreement)
    return false;
  if (there.agree < clearly_more * here.agree)
    return !isContradicted(there) && there.violating <= noise_violation * there.agree &&
           !contradictsMore(there, here, judge_.unit());
  const double more = there.agree / std::max(here.agree, 1.0 / judge_.unit());
  FreeSpaceEvidence as_much = here, half = there;
  as_much.violating *= more;
  as_much.clustered *= more;
  half.clustered *= 0.5;
  return !isContradicted(half) && !contradictsMore(there, as_much, judge_.unit());
}

bool PartCheck::isMisplaced(const ClusterPart& placed)
{
  constexpr double clearly = 0.5; // errors of poses add up in large clusters
  FreeSpaceEvidence half = placed.here;
  half.clustered *= clearly;
  return isContradicted(half);
}

std::vector<ScanCluster> PartCheck::heldTogether(const ScanCluster& cluster) const
{
  constexpr double least_agreement = 0.1; // of a scan's points: less, and a wrong place has it
  std::vector<ScanCluster> parts;
  std::vector<char> reached(cluster.scans.size(), 0);
  for (std::size_t start = 0; start < reached.size(); ++start) {
    if (reached[start])
      continue;
    std::vector<std::size_t> members{start};
    reached[start] = 1;
    for (std::size_t k = 0; k < members.size(); ++k)
      for (std::size_t other = 0; other < reached.size(); ++other)
        if (!reached[other] && judge_.judge(cluster.scans[members[k]], cluster.scans[other],
                                            cluster.poses[members[k]].inverse() * cluster.poses[other])
                                       .agree >= least_agreement) {
          reached[other] = 1;
          members.push_back(other);
        }
    std::sort(members.begin(), members.end());
    ScanCluster& part = parts.emplace_back();
    for (const std::size_t k : members) {
      part.scans.push_back(cluster.scans[k]);
      part.poses.push_back(cluster.poses[k]);
    }
  }
  return parts;
}

bool PartCheck::fitsElsewhere(const ClusterPart& placed) const
{
  constexpr double least_overlap = 0.15, least_of_one = 0.3; // of two pairs, of one: less, and chance explains it
  for (const ClusterFit& rough : fitter_.rough(placed.rest, placed.part)) {
    if (!rough.certain && rough.overlap < (rough.pairs < 2 ? least_of_one : least_overlap))
      continue;
    const ClusterFit fit = fitter_.settled(placed.rest, placed.part, rough);
    if (!fitter_.isSame(placed.part, fit.T, Eigen::Isometry3d::Identity(), 3.0) &&
        isUndecided(placed.here, fit.evidence))
      return true;
  }
  return false;
}

bool PartCheck::isClaimed(const ScanCluster& claimer, const ClusterPart& placed) const
{
  constexpr double least_share = 0.25; // of the surfaces that agree here
  for (const ClusterFit& rough : fitter_.rough(claimer, placed.part)) {
    if (!rough.certain)
      continue;
    const ClusterFit fit = fitter_.settled(claimer, placed.part, rough);
    if (fit.evidence.agree >= least_share * placed.here.agree && isUndecided(placed.here, fit.evidence) &&
        isContradicted(judge_.judge(placed.rest, claimer, fit.T.inverse())))
      return true;
  }
  return false;
}

bool PartCheck::mayBeMoved(const ClusterPart& placed, const IsometryVector& motions) const
{
  return std::any_of(motions.begin(), motions.end(), [&](const Eigen::Isometry3d& T) {
    return isUndecided(placed.here, judge_.judge(placed.rest, placed.part, T));
  });
}

bool PartCheck::haveTwinPlaces(const ScanCluster& whole, const ScanCluster& part, const ScanCluster& rest) const
{
  const auto common = [&](const ClusterFits& fits, const ClusterFits& others) {
    ClusterFits found;
    for (const ClusterFit& fit : fits)
      if (std::any_of(others.begin(), others.end(),
                      [&](const ClusterFit& other) { return fitter_.isSame(part, fit.T, other.T, 3.0); }))
        found.push_back(fit);
    return found;
  };
  const ClusterFits of_rest = fitter_.rough(whole, rest);
  ClusterFits shared = common(fitter_.rough(whole, part), of_rest);
  if (shared.size() < 2) // to judge them costs much
    return false;
  shared = fitter_.uncontradicted(whole, part, shared);
  shared = common(shared, fitter_.uncontradicted(whole, rest, common(of_rest, shared)));
  return std::any_of(shared.begin(), shared.end(), [&](const ClusterFit& fit) {
    return std::any_of(shared.begin(), shared.end(),
                       [&](const ClusterFit& other) { return &fit != &other && rivals(other, fit, judge_.unit()); });
  });
}
} // namespace fresco::registration
