// SPDX-License-Identifier: BSD-3-Clause
#include "answer/more_pairs.h"
#include "graph/moved_people.h"
#include "graph/scan_exchange.h"
#include "graph/scan_plans.h"
#include "scan/lists.h"
#include <algorithm>
#include <map>
namespace fresco::registration {
void restoreScans(const AlignmentInput& input, const GlobalAlignment& alignment, int threads)
{
  if (alignment.signs.empty()) // nothing was searched
    return;
  confirmViewpoints(input.scans, alignment.signs);
  if (alignment.people_moved)
    spareDoubtful(input.scans, findPlanFrames(input.scans, threads), threads);
  for (std::size_t k = 0; k < input.scans.size(); ++k) {
    if (!alignment.distrusted[k].empty())
      distrustViewpoint(input.scans[k], alignment.distrusted[k]);
    input.scans[k].aliases = alignment.aliases[k];
  }
}

void alignMore(const AlignmentInput& input, const ScanRegistrationOptions& options, const std::vector<ScanPair>& asked,
               std::vector<PairAlignment>& pairs)
{
  PairAlignmentOptions pair_options;
  pair_options.verification.min_overlap = options.min_overlap;
  pair_options.verification.max_violation = options.max_violation;
  pair_options.upright = options.upright;
  PlanFrames frames = knownFrames(input.scans, input.known, options.threads);
  const std::vector<PlanSpectrum> plans = drawPlans(input.scans, frames, options.threads);
  FeatureOptions feature_options;
  feature_options.threads = options.threads;
  std::map<Index, ScanFeatures> features;
  for (const ScanPair& pair : asked)
    for (const Index scan : {pair.a, pair.b})
      if (features.count(scan) == 0) {
        prepareManySearches(input.scans[scan]);
        features[scan] = describeScan(input.scans[scan], feature_options);
      }
  std::vector<PairAlignment> aligned(asked.size());
  forEachTask(asked.size(), options.threads, [&](Index k) {
    const auto& [a, b] = asked[k];
    if (!isOwn(input.ranks, k))
      return;
    aligned[k] = alignPair({input.scans[a], features.at(a), &plans[a]}, {input.scans[b], features.at(b), &plans[b]},
                           pair_options);
    aligned[k].a = a;
    aligned[k].b = b;
  });
  shareItems(input.ranks, aligned);
  const auto order = [](const PairAlignment& x, const PairAlignment& y) {
    return std::pair(x.a, x.b) < std::pair(y.a, y.b);
  };
  for (const PairAlignment& pair : aligned)
    pairs.insert(std::upper_bound(pairs.begin(), pairs.end(), pair, order), pair);
}
} // namespace fresco::registration
