// SPDX-License-Identifier: BSD-3-Clause
#include "pair/self_alignment.h"
#include "pair/feature_matching.h"
#include "pair/pair_verification.h"
#include "pair/partial_alias.h"
#include <algorithm>
#include <numeric>
namespace fresco::registration {
namespace {
std::vector<Index> allOf(const ScanFeatures& features)
{
  std::vector<Index> all(features.points.cols());
  std::iota(all.begin(), all.end(), Index(0));
  return all;
}

// Poses of a scan on itself, the identity among them.
VerifiedHypotheses alignToSelf(const PreparedScan& scan, const ScanFeatures& features, const Sc2PcrOptions& sc2_pcr)
{
  constexpr int matches_a_feature = 3; // places that look like a feature's, which may be one of many
  VerificationOptions options;
  options.max_violation *= 2.f; // of a pair: the best of a family of poses violates less
  options.refined = options.checked;
  const float apart = alias_distance * scan.size;
  const std::vector<Correspondence> matches = matchToSelf(features, {allOf(features), apart, apart, matches_a_feature});
  return verifyHypotheses(PairGeometry(scan, scan), {runSc2Pcr(features, features, matches, sc2_pcr), {}, {}}, options);
}

} // namespace

ScanAlias toAlias(const VerifiedHypothesis& own)
{
  constexpr double certain_overlap = 0.5;     // with itself: less, and the scan is laid where it saw nothing
  constexpr double certain_violation = 0.004; // twice what noise causes: nothing speaks against the alias
  const bool wide = own.check.overlap > certain_overlap;
  ScanAlias alias;
  alias.T = own.T_a_b;
  alias.certain = wide && own.check.violation < certain_violation && own.check.color.value_or(1.0) > alias_color;
  alias.violation = own.check.violation;
  alias.likeness = wide && own.check.violation <= VerificationOptions().max_violation ? own.check.overlap : 0.0;
  return alias;
}

ScanAliases findAliases(const PreparedScan& scan, const ScanFeatures& features)
{
  if (!sawAround(scan)) // it knows too little that could reject an alias
    return {};
  Sc2PcrOptions sc2_pcr;
  sc2_pcr.tolerance = 1.5f * scan.levels[1].voxel;
  sc2_pcr.size = scan.size;
  sc2_pcr.exclusive = true;
  const float apart = alias_distance * scan.size;
  ScanAliases aliases;
  for (const VerifiedHypothesis& own : alignToSelf(scan, features, sc2_pcr))
    if (poseDistance(own.T_a_b, Eigen::Isometry3d::Identity(), scan.size) > apart)
      aliases.push_back(toAlias(own));
  if (std::none_of(aliases.begin(), aliases.end(), [](const ScanAlias& alias) { return alias.certain; }))
    for (const ScanAlias& alias : findPartialAliases(scan, matchFarToNear(scan, features, sc2_pcr)))
      aliases.push_back(alias);
  return aliases;
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
