// SPDX-License-Identifier: BSD-3-Clause
#include "pair/pair_alignment.h"
#include "pair/feature_matching.h"
#include "pair/plane_matching.h"
#include "scan/lists.h"
#include <algorithm>
namespace fresco::registration {
namespace {
bool isUpright(const Eigen::Isometry3d& T)
{
  constexpr double upright_cosine = 0.93; // 21 degrees: twice the tilt of an upright scanner
  return T.linear()(2, 2) >= upright_cosine;
}

// Where a scan saw two places that look alike, what fits the one fits the other.
class AliasHypotheses {
public:
  AliasHypotheses(const PairGeometry& pair, const PairAlignmentOptions& options) : pair_(pair), options_(options) {}

  // Adds poses in which the scans lie at the other place to hypotheses, which are in order.
  void addTo(VerifiedHypotheses& hypotheses) const
  {
    constexpr std::size_t most_origins = 3; // of the best: each costs a refinement per alias
    for (std::size_t k = 0, count = std::min(most_origins, hypotheses.size()); k < count; ++k)
      for (const bool of_a : {true, false})
        for (const ScanAlias& alias : (of_a ? pair_.a : pair_.b).aliases)
          if (const Eigen::Isometry3d& T = hypotheses[k].T_a_b; !alias.partial)
            consider(hypotheses, k, {of_a ? alias.T * T : T * alias.T, alias.certain});
    sortFalling(hypotheses, &VerifiedHypothesis::score);
  }

private:
  void consider(VerifiedHypotheses& hypotheses, std::size_t origin, const ScanAlias& candidate) const
  {
    auto known = findNear(pair_, hypotheses, candidate.T, 3.0 * pair_.grain);
    if (known == hypotheses.end()) {
      PoseHypothesis start;
      start.T_a_b = candidate.T;
      const VerifiedHypothesis verified = verifyHypothesis(pair_, start);
      known = findNear(pair_, hypotheses, verified.T_a_b, pair_.grain);
      const bool fits = verified.check.violation <= options_.verification.max_violation &&
                        (candidate.certain || verified.check.overlap >= options_.verification.min_overlap) &&
                        (!options_.upright || isUpright(verified.T_a_b));
      if (known == hypotheses.end() && fits)
        known = hypotheses.insert(hypotheses.end(), verified);
    }
    if (known != hypotheses.end() && candidate.certain && known != hypotheses.begin() + origin)
      known->has_alias = hypotheses[origin].has_alias = true;
  }

  const PairGeometry& pair_;
  const PairAlignmentOptions& options_;
};

// Without free space too little tells which planes are the same.
FoundHypotheses findHypotheses(const DescribedScan& a, const DescribedScan& b, const PairGeometry& pair,
                               const PairAlignmentOptions& options)
{
  constexpr std::size_t most_by_planes = 200; // the right one is among the first hundred where a tenth overlaps
  constexpr std::size_t most_matches = 1500;  // of features
  Sc2PcrOptions sc2_pcr;
  sc2_pcr.tolerance = 1.5f * a.scan.levels[1].voxel;
  sc2_pcr.size = pair.size;
  FoundHypotheses found;
  found.features = runSc2Pcr(a.features, b.features, matchFeatures(a.features, b.features, most_matches), sc2_pcr);
  if (!a.scan.free_space.empty() && !b.scan.free_space.empty())
    found.planes = matchPlanes(a.features.planes, b.features.planes, most_by_planes);
  if (a.plan && b.plan)
    found.plans = matchPlans(*a.plan, *b.plan, most_by_plans);
  if (options.upright)
    for (PoseHypotheses* poses : {&found.features, &found.planes, &found.plans})
      keepUpright(*poses);
  return found;
}
} // namespace

void keepUpright(PoseHypotheses& poses)
{
  removeIf(poses, [](const PoseHypothesis& hypothesis) { return !isUpright(hypothesis.T_a_b); });
}

PairAlignmentOptions pairOptions(const ScanRegistrationOptions& options)
{
  PairAlignmentOptions pair;
  pair.verification.min_overlap = options.min_overlap;
  pair.verification.max_violation = options.max_violation;
  pair.upright = options.upright;
  return pair;
}

PairAlignment alignPair(const DescribedScan& a, const DescribedScan& b, const PairAlignmentOptions& options)
{
  const PairGeometry pair(a.scan, b.scan);
  const FoundHypotheses found = findHypotheses(a, b, pair, options);
  PairAlignment alignment;
  alignment.hypotheses = verifyHypotheses(pair, found, options.verification);
  AliasHypotheses(pair, options).addTo(alignment.hypotheses);
  alignment.ambiguous = isAmbiguous(pair, alignment.hypotheses);
  const PoseHypotheses& popular_first = found.features;
  if (alignment.hypotheses.empty() && !popular_first.empty() && popular_first[0].votes >= many_votes) {
    const VerifiedHypothesis popular = verifyHypothesis(pair, popular_first[0]);
    if (popular.check.violation > options.verification.max_violation &&
        popular.check.overlap >= 2 * options.verification.min_overlap) // free space alone speaks against it
      alignment.rejected = {popular};
  }
  return alignment;
}

PairAlignment alignByPlans(const PlannedScan& a, const PlannedScan& b, const VerificationOptions& options)
{
  const PairGeometry pair(a.scan, b.scan);
  FoundHypotheses found;
  found.planes = matchPlans(a.plan, b.plan, most_by_plans);
  PairAlignment alignment;
  alignment.hypotheses = verifyHypotheses(pair, found, options);
  alignment.ambiguous = isAmbiguous(pair, alignment.hypotheses);
  return alignment;
}
} // namespace fresco::registration
