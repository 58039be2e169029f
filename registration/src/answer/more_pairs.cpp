// SPDX-License-Identifier: BSD-3-Clause
#include "answer/more_pairs.h"
#include "graph/moved_people.h"
#include "graph/scan_exchange.h"
#include "graph/scan_plans.h"
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

void alignMore(const AlignmentInput& input, const ScanRegistrationOptions& options,
               const std::vector<RankedPair>& asked, std::vector<PairAlignment>& pairs)
{
  PlanFrames frames = knownFrames(input.scans, input.known, options.threads);
  const std::vector<PlanSpectrum> plans = drawPlans(input.scans, frames, options.threads);
  std::map<Index, ScanFeatures> features;
  for (const RankedPair& pair : asked)
    for (const Index scan : {pair.a, pair.b})
      if (features.count(scan) == 0) {
        prepareManySearches(input.scans[scan]);
        features[scan] = describeScan(input.scans[scan], options.threads);
      }
  const PairAlignmentOptions pair_options = pairOptions(options);
  const auto align = [&](Index a, Index b) {
    return alignPair({input.scans[a], features.at(a), &plans[a]}, {input.scans[b], features.at(b), &plans[b]},
                     pair_options);
  };
  addPairs(alignAll(input.ranks, options.threads, asked, align), pairs);
}
} // namespace fresco::registration
