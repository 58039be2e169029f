// SPDX-License-Identifier: BSD-3-Clause
#include "pair/plan_alignment.h"
#include "pair/partial_alias.h"
#include "pair/place_likeness.h"
#include "pair/self_alignment.h"
#include <algorithm>
namespace fresco::registration {
namespace {
constexpr std::size_t most_rough = 8;    // of pairs that overlap by 0.25, three of four are first among them
constexpr std::size_t most_aligned = 16; // of 28 such pairs of four floors 26 are right with 8, 27 with 16, 27 with 32
} // namespace

double planLikeness(const PlannedScan& a, const PlannedScan& b)
{
  double best = 0.0;
  for (const PoseHypothesis& pose : matchPlans(a.plan, b.plan, most_rough))
    best = std::max(best, roughLikeness(a.scan, b.scan, pose.T_a_b, best));
  return best;
}

PairAlignment alignByPlans(const PlannedScan& a, const PlannedScan& b, const VerificationOptions& options)
{
  FoundHypotheses found;
  found.planes = matchPlans(a.plan, b.plan, most_aligned);
  PairAlignment alignment;
  const PairGeometry pair(a.scan, b.scan);
  alignment.hypotheses = verifyHypotheses(pair, found, options);
  alignment.ambiguous = isAmbiguous(pair, alignment.hypotheses);
  return alignment;
}

ScanAliases findAliasesByPlan(const PlannedScan& scan)
{
  constexpr std::size_t most_aliases = 16;
  if (scan.plan.empty() || !sawAround(scan.scan)) // else it knows too little that could reject an alias
    return {};
  VerificationOptions options;
  options.max_violation *= 2.f; // of a pair: the best of a family of poses violates less
  options.refined = options.checked;
  FoundHypotheses found;
  found.planes = matchPlans(scan.plan, scan.plan, most_aliases);
  ScanAliases aliases;
  for (const VerifiedHypothesis& own : verifyHypotheses(PairGeometry(scan.scan, scan.scan), found, options))
    if (poseDistance(own.T_a_b, Eigen::Isometry3d::Identity(), scan.scan.size) > alias_distance * scan.scan.size)
      aliases.push_back(toAlias(own));
  if (std::none_of(aliases.begin(), aliases.end(), [](const ScanAlias& alias) { return alias.certain; }))
    for (const ScanAlias& alias : findPartialAliases(scan.scan, found.planes))
      aliases.push_back(alias);
  return aliases;
}
} // namespace fresco::registration
