// SPDX-License-Identifier: BSD-3-Clause
#include "pair/self_alignment.h"
#include "pair/feature_matching.h"
#include "pair/partial_alias.h"
#include <algorithm>
#include <functional>
#include <numeric>
namespace fresco::registration {
namespace {
// Of a verified pose of a scan on itself.
ScanAlias toAlias(const VerifiedHypothesis& own)
{
  constexpr double certain_overlap = 0.5; // with itself: less, and the scan is laid where it saw nothing
  return {own.T_a_b, own.check.overlap > certain_overlap && own.check.violation < 2.0 * noise_violation &&
                         own.check.color.value_or(1.0) > good_color};
}

// Of poses of a scan on itself, the identity among them; partial ones, from motions of their own, where none is certain.
ScanAliases findAliases(const PreparedScan& scan, const FoundHypotheses& found,
                        const std::function<PoseHypotheses()>& partial)
{
  VerificationOptions options;
  options.max_violation *= 2.f; // of a pair: the best of a family of poses violates less
  options.refined = options.checked;
  ScanAliases aliases;
  for (const VerifiedHypothesis& own : verifyHypotheses(PairGeometry(scan, scan), found, options))
    if (isElsewhere(scan, own.T_a_b))
      aliases.push_back(toAlias(own));
  if (std::none_of(aliases.begin(), aliases.end(), [](const ScanAlias& alias) { return alias.certain; }))
    for (const ScanAlias& alias : findPartialAliases(scan, partial()))
      aliases.push_back(alias);
  return aliases;
}
} // namespace

ScanAliases findAliases(const PreparedScan& scan, const ScanFeatures& features)
{
  constexpr int matches_a_feature = 3; // places that look like a feature's, which may be one of many
  if (!sawAround(scan))                // it knows too little that could reject an alias
    return {};
  Sc2PcrOptions sc2_pcr;
  sc2_pcr.tolerance = 1.5f * scan.levels[1].voxel;
  sc2_pcr.size = scan.size;
  sc2_pcr.exclusive = true;
  std::vector<Index> all(features.points.cols());
  std::iota(all.begin(), all.end(), Index(0));
  const float apart = alias_distance * scan.size;
  FoundHypotheses found;
  found.features =
      runSc2Pcr(features, features, matchToSelf(features, {all, apart, apart, matches_a_feature}), sc2_pcr);
  return findAliases(scan, found, [&] { return matchFarToNear(scan, features, sc2_pcr); });
}

ScanAliases findAliasesByPlan(const PlannedScan& scan)
{
  if (scan.plan.empty() || !sawAround(scan.scan))
    return {};
  FoundHypotheses found;
  found.planes = matchPlans(scan.plan, scan.plan, most_by_plans);
  return findAliases(scan.scan, found, [&] { return found.planes; });
}

void addAliases(const ScanAliases& more, double size, ScanAliases& aliases)
{
  for (const ScanAlias& alias : more)
    if (std::none_of(aliases.begin(), aliases.end(), [&](const ScanAlias& known) {
          return (known.certain || !alias.certain) && poseDistance(known.T, alias.T, size) < alias_distance * size;
        }))
      aliases.push_back(alias);
}
} // namespace fresco::registration
