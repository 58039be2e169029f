// SPDX-License-Identifier: BSD-3-Clause
#include "assembly/cluster_fits.h"
namespace fresco::registration {
namespace {
// Whether pairs say enough of a place to join two clusters by it. A few that all have a better one elsewhere do not: from
// one of two equal rooms, several scans see the other alike.
bool isConvincing(const ClusterFit& fit)
{
  constexpr double least_overlap = 0.2; // of the best pair
  constexpr Index few = 2;
  return (fit.sound || fit.pairs > few) && fit.overlap >= least_overlap;
}
} // namespace

bool isJoinable(const ClusterFit& fit)
{
  constexpr double least_agreement = 0.5; // of a scan's points: a quarter of two
  return isConvincing(fit) && fit.evidence.confirmed >= least_agreement;
}

bool isSeenAsWell(const ClusterFit& other, const ClusterFit& fit)
{
  return other.certain || other.overlap >= chance_share * fit.overlap;
}

bool rivals(const ClusterFit& other, const ClusterFit& fit, double unit)
{
  constexpr double least_share = 0.25; // of what is confirmed at this place: less, and chance explains it
  return other.evidence.confirmed >= least_share * fit.evidence.confirmed &&
         !contradictsMore(other.evidence, fit.evidence, unit) && isSeenAsWell(other, fit);
}

bool ClusterFitter::isSame(const ScanCluster& moving, const Eigen::Isometry3d& T, const Eigen::Isometry3d& other,
                           double tolerances) const
{
  return poseDistance(T * moving.poses[0], other * moving.poses[0], input_.scans[moving.scans[0]].size) <
         tolerances * input_.options.tolerance;
}

void ClusterFitter::add(const ScanCluster& second, const ClusterFit& fit, ClusterFits& fits) const
{
  for (ClusterFit& known : fits)
    if (isSame(second, known.T, fit.T, 2.0)) {
      ++known.pairs;
      known.sound = known.sound || fit.sound;
      known.certain = known.certain || fit.certain;
      if (fit.overlap > known.overlap) {
        known.overlap = fit.overlap;
        known.T = fit.T;
      }
      return;
    }
  fits.push_back(fit);
}

ClusterFits ClusterFitter::rough(const ScanCluster& first, const ScanCluster& second) const
{
  ClusterFits fits;
  std::map<Index, std::size_t> positions;
  for (std::size_t k = 0; k < second.scans.size(); ++k)
    positions[second.scans[k]] = k;
  for (std::size_t i = 0; i < first.scans.size(); ++i)
    for (const PairAlignment* pair : input_.pairs_of[first.scans[i]]) {
      const bool turned = pair->b == first.scans[i];
      const auto other = positions.find(turned ? pair->a : pair->b);
      if (other == positions.end())
        continue;
      for (const VerifiedHypothesis& hypothesis : pair->hypotheses) {
        if (hypothesis.check.violation > pane_violation || hypothesis.check.color.value_or(1.0) < input_.least_color ||
            contradictsOneRoom(hypothesis.check, input_.usual_violation))
          continue;
        ClusterFit fit;
        fit.T = first.poses[i] * (turned ? hypothesis.T_a_b.inverse() : hypothesis.T_a_b) *
                second.poses[other->second].inverse();
        fit.pairs = 1;
        fit.overlap = hypothesis.check.overlap;
        fit.sound = isSound(*pair, hypothesis);
        fit.certain = fit.sound && !pair->ambiguous;
        add(second, fit, fits);
      }
    }
  return fits;
}

ClusterFits ClusterFitter::uncontradicted(const ScanCluster& first, const ScanCluster& second,
                                          const ClusterFits& rough) const
{
  ClusterFits fits;
  for (ClusterFit fit : rough) {
    fit.evidence = judge_.judge(first, second, fit.T);
    if (!isContradicted(fit.evidence))
      fits.push_back(fit);
  }
  return fits;
}

ClusterFits ClusterFitter::find(const ScanCluster& first, const ScanCluster& second) const
{
  ClusterFits fits = rough(first, second);
  const auto others = std::stable_partition(fits.begin(), fits.end(),
                                            [](const ClusterFit& fit) { return fit.certain || isConvincing(fit); });
  ClusterFits found = uncontradicted(first, second, ClusterFits(fits.begin(), others));
  ClusterFits rivals;
  std::copy_if(others, fits.end(), std::back_inserter(rivals), [&](const ClusterFit& other) {
    return std::any_of(found.begin(), found.end(),
                       [&](const ClusterFit& fit) { return isJoinable(fit) && isSeenAsWell(other, fit); });
  });
  for (const ClusterFit& fit : uncontradicted(first, second, rivals))
    found.push_back(fit);
  return found;
}
} // namespace fresco::registration
