// SPDX-License-Identifier: BSD-3-Clause
#include "global_alignment.h"
#include "assembly/part_exchange.h"
#include "assembly/scan_assembly.h"
#include "assembly/submap_joining.h"
#include "graph/cluster_poses.h"
#include "graph/moved_people.h"
#include "graph/scan_exchange.h"
#include "graph/scan_plans.h"
#include "graph/viewpoint_check.h"
#include "pair/pair_ranking.h"
#include "pair/partial_alias.h"
#include "pair/self_alignment.h"
#include "scan/lists.h"
#include <algorithm>
namespace fresco::registration {
namespace {
std::vector<RankedPair> possiblePairs(const std::vector<PreparedScan>& scans, const ScanCluster& known)
{
  std::vector<RankedPair> pairs;
  const Index n = scans.size();
  const auto usable = [&](Index i) { return scans[i].problem.empty(); };
  for (Index a = 0; a < n; ++a)
    for (Index b = a + 1; b < n; ++b)
      if (usable(a) && usable(b) && !(contains(known, a) && contains(known, b)))
        pairs.push_back({a, b, 0.0});
  return pairs;
}

class GlobalAligner {
public:
  GlobalAligner(const AlignmentInput& input, const ScanRegistrationOptions& options)
      : scans_(input.scans), known_(input.known), ranks_(input.ranks), options_(options)
  {}

  GlobalAlignment run(const Progress& progress);

private:
  void confirmViewpoints();
  bool hasAllPlans() const;
  std::vector<PairAlignment> alignByPlans(const std::vector<RankedPair>& pairs);
  bool sparePeople(std::vector<RankedPair> pairs);
  std::vector<RankedPair> pairsByPlans() const;
  void assembleByPlans(const std::vector<RankedPair>& pairs, const Progress& progress);
  void alignInRounds(const Progress& progress);
  void describe(const Progress& progress);
  void prepareForPairs(const std::vector<RankedPair>& round);
  ScanAliases aliasesOf(Index scan) const;
  bool manyPlaces() const;
  bool hasFew() const;
  bool hasMany(std::size_t pairs) const;
  std::vector<RankedPair> orderedPairs() const;
  void leaveOutJoined(std::vector<RankedPair>& pairs) const;
  void alignPairs(const std::vector<RankedPair>& round);
  void correctViewpoints();
  GraphInput graphInput() const;
  bool hangsTogether() const { return result_.graph.clusters.size() <= 1; }

  std::vector<PreparedScan>& scans_;
  const ScanCluster& known_;
  Exchange& ranks_;
  const ScanRegistrationOptions& options_;
  PlanFrames frames_;               // of all scans; empty where no plan can be drawn
  std::vector<PlanSpectrum> plans_; // of all scans, empty where there is none
  std::vector<ScanFeatures> features_;
  std::vector<char> has_aliases_; // per scan, whether they were looked for
  GlobalAlignment result_;
};

void GlobalAligner::confirmViewpoints()
{
  result_.signs =
      mapShared(ranks_, options_.threads, scans_.size(), [&](Index k) { return findViewpointSign(scans_[k], 1); });
  registration::confirmViewpoints(scans_, result_.signs);
}

bool GlobalAligner::hasAllPlans() const
{
  const Index drawn =
      std::count_if(frames_.begin(), frames_.end(), [](const auto& frame) { return frame.has_value(); });
  return drawn > 0 && drawn == countUsable(scans_);
}

// Whether people moved between the scans. If so, they are spared from now on.
bool GlobalAligner::sparePeople(std::vector<RankedPair> pairs)
{
  if (pairs.empty())
    return false;
  constexpr std::size_t most_tried = 64; // tells enough, and costs a tenth of what the rounds do
  pairs.resize(std::min(most_tried, pairs.size()));
  spareDoubtful(scans_, frames_, options_.threads);
  const bool moved = peopleMoved(scans_, alignByPlans(pairs), options_.threads);
  if (!moved)
    spareNothing(scans_);
  for (PreparedScan& scan : scans_)
    for (ScanLevel& level : scan.levels)
      level.grid.reset();
  return moved;
}

// The likeliest partners of each scan.
std::vector<RankedPair> GlobalAligner::pairsByPlans() const
{
  constexpr Index partners = 12; // overlap by a quarter with fewer
  std::vector<RankedPair> pairs = possiblePairs(scans_, known_);
  forEachTask(pairs.size(), options_.threads, [&](Index k) {
    const Index a = pairs[k].a, b = pairs[k].b;
    pairs[k].likeness = planLikeness({scans_[a], plans_[a]}, {scans_[b], plans_[b]});
  });
  return firstPartners(std::move(pairs), scans_.size(), partners);
}

std::vector<PairAlignment> GlobalAligner::alignByPlans(const std::vector<RankedPair>& pairs)
{
  forEachTask(scans_.size(), options_.threads, [&](Index k) { prepareManySearches(scans_[k]); });
  const VerificationOptions options = pairOptions(options_).verification;
  return alignAll(ranks_, options_.threads, pairs, [&](Index a, Index b) {
    return registration::alignByPlans({scans_[a], plans_[a]}, {scans_[b], plans_[b]}, options);
  });
}

void GlobalAligner::assembleByPlans(const std::vector<RankedPair>& pairs, const Progress& progress)
{
  report(progress, "align pairs", 0.3);
  addPairs(alignByPlans(pairs), result_.pairs);
  std::vector<ScanAliases> aliases = mapShared(ranks_, options_.threads, scans_.size(), [&](Index k) {
    return findAliasesByPlan({scans_[k], plans_[k]});
  });
  for (std::size_t k = 0; k < scans_.size(); ++k)
    scans_[k].aliases = std::move(aliases[k]);
  sharePartialAliases(scans_, result_.pairs);
  report(progress, "assemble", 0.7);
  result_.graph = hasFew() ? buildScanGraph(graphInput(), known_) : assembleScans(graphInput());
}

void GlobalAligner::describe(const Progress& progress)
{
  const Index count = scans_.size();
  features_.resize(scans_.size());
  for (Index k = 0; k < count; ++k) {
    report(progress, "describe", 0.3 * static_cast<double>(k) / static_cast<double>(count));
    if (isOwn(ranks_, k) && scans_[k].problem.empty())
      features_[k] = describeScan(scans_[k], options_.threads);
  }
  shareItems(ranks_, features_);
  has_aliases_.assign(scans_.size(), 0);
}

// Prepares the scans of a round that have not been in one before, and finds their aliases.
void GlobalAligner::prepareForPairs(const std::vector<RankedPair>& round)
{
  std::vector<Index> fresh;
  for (const RankedPair& pair : round)
    for (const Index scan : {pair.a, pair.b})
      if (!has_aliases_[scan]) {
        has_aliases_[scan] = 1;
        fresh.push_back(scan);
      }
  if (fresh.empty())
    return;
  forEachTask(fresh.size(), options_.threads, [&](Index k) { prepareManySearches(scans_[fresh[k]]); });
  std::vector<ScanAliases> aliases =
      mapShared(ranks_, options_.threads, fresh.size(), [&](Index k) { return aliasesOf(fresh[k]); });
  for (std::size_t k = 0; k < fresh.size(); ++k)
    scans_[fresh[k]].aliases = std::move(aliases[k]);
}

ScanAliases GlobalAligner::aliasesOf(Index scan) const
{
  ScanAliases aliases = findAliases(scans_[scan], features_[scan]);
  addAliases(findAliasesByPlan({scans_[scan], plans_[scan]}), scans_[scan].size, aliases);
  return aliases;
}

void GlobalAligner::alignPairs(const std::vector<RankedPair>& round)
{
  const PairAlignmentOptions options = pairOptions(options_);
  prepareForPairs(round);
  const auto align = [&](Index a, Index b) {
    return alignPair({scans_[a], features_[a], &plans_[a]}, {scans_[b], features_[b], &plans_[b]}, options);
  };
  addPairs(alignAll(ranks_, options_.threads, round, align), result_.pairs);
}

// Aligns the pairs of scans with wrong viewpoints again, without their free space.
void GlobalAligner::correctViewpoints()
{
  const auto find = [&] { return wrongViewpoints(scans_, result_.pairs, options_.max_violation); };
  for (std::vector<char> wrong = find(); std::find(wrong.begin(), wrong.end(), 1) != wrong.end(); wrong = find()) {
    for (std::size_t i = 0; i < scans_.size(); ++i)
      if (wrong[i]) {
        result_.distrusted[i] = "its viewpoint contradicts the other scans";
        distrustViewpoint(scans_[i], result_.distrusted[i]);
        features_[i] = describeScan(scans_[i], options_.threads);
      }
    std::vector<RankedPair> again;
    std::vector<PairAlignment> kept;
    for (const PairAlignment& pair : result_.pairs)
      if (wrong[pair.a] || wrong[pair.b])
        again.push_back({pair.a, pair.b, 0.0});
      else
        kept.push_back(pair);
    result_.pairs = kept;
    alignPairs(again);
  }
}

GraphInput GlobalAligner::graphInput() const { return {scans_, result_.pairs, graphOptions(options_)}; }

// Up to so many scans are aligned in rounds: of more, these place hardly more, some wrongly, in six times the time.
bool GlobalAligner::hasFew() const
{
  constexpr Index most_in_rounds = 16;
  return countUsable(scans_) <= most_in_rounds;
}

// Whether features alone rank pairs too badly.
bool GlobalAligner::manyPlaces() const
{
  constexpr Index most_ranked_by_features = 30;
  return countUsable(scans_) > most_ranked_by_features || !known_.scans.empty();
}

bool GlobalAligner::hasMany(std::size_t pairs) const
{
  constexpr std::size_t all_pairs = 30; // up to this many are tried without ranking, which would cost as much
  return pairs > all_pairs || !known_.scans.empty();
}

// Pairs of scans that hang together already.
void GlobalAligner::leaveOutJoined(std::vector<RankedPair>& pairs) const
{
  const std::vector<ClusterPlace> places = placesOf(result_.graph.clusters, scans_.size());
  removeIf(pairs, [&](const RankedPair& pair) { return places[pair.a].cluster == places[pair.b].cluster; });
}

// The likeliest first where there are many.
std::vector<RankedPair> GlobalAligner::orderedPairs() const
{
  std::vector<RankedPair> pairs = possiblePairs(scans_, known_);
  if (hasMany(pairs.size()))
    rankPairs(pairs, scans_, features_, {manyPlaces(), options_.upright, options_.threads});
  return pairs;
}

void GlobalAligner::alignInRounds(const Progress& progress)
{
  constexpr int most_rounds = 6;       // 24 partners of each scan: more than overlap with it
  constexpr int most_place_rounds = 4; // the right ones come sooner
  describe(progress);
  std::vector<RankedPair> pairs = orderedPairs();
  const bool in_rounds = hasMany(pairs.size());
  const int rounds = manyPlaces() ? most_place_rounds : most_rounds;
  std::vector<char> has_place(scans_.size(), 0);
  for (const Index scan : known_.scans)
    has_place[scan] = 1;
  for (int round = 0; round < rounds; ++round) {
    report(progress, "align pairs", 0.3 + 0.7 * round / rounds);
    if (round > 0 && manyPlaces())
      leaveOutJoined(pairs);
    alignPairs(in_rounds ? takeRound(pairs, has_place) : pairs);
    correctViewpoints();
    sharePartialAliases(scans_, result_.pairs);
    result_.graph = buildScanGraph(graphInput(), known_);
    if (!in_rounds || pairs.empty() || hangsTogether())
      break;
  }
  if (!frames_.empty() && !hasFew()) // whole clusters tell more than the pairs, which place some of these wrongly
    result_.graph = assembleScans(graphInput());
}

GlobalAlignment GlobalAligner::run(const Progress& progress)
{
  confirmViewpoints();
  result_.distrusted.resize(scans_.size());
  frames_ = knownFrames(scans_, known_, options_.threads);
  plans_ = drawPlans(scans_, frames_, options_.threads);
  std::vector<RankedPair> pairs = hasAllPlans() ? pairsByPlans() : std::vector<RankedPair>();
  const bool people_moved = sparePeople(pairs);
  if (people_moved) { // plans are drawn with more care then
    plans_ = drawPlans(scans_, frames_, options_.threads);
    pairs = pairsByPlans();
  }
  if (people_moved || (hasAllPlans() && !hasFew())) // rounds place some of these wrongly
    assembleByPlans(pairs, progress);
  else
    alignInRounds(progress);
  const GraphInput input = graphInput();
  for (ScanCluster& cluster : result_.graph.clusters)
    closeLoops(input, known_, cluster);
  if (!frames_.empty())
    joinSubmaps(input, frames_, result_.graph, progress);
  partSecondPlaces(input, known_, result_.graph);
  for (const PreparedScan& scan : scans_)
    result_.aliases.push_back(scan.aliases);
  result_.people_moved = people_moved;
  return std::move(result_);
}

} // namespace

GraphOptions graphOptions(const ScanRegistrationOptions& options)
{
  return {options.max_violation, 4.f * options.voxel, options.threads};
}

GlobalAlignment alignGlobally(const AlignmentInput& input, const ScanRegistrationOptions& options,
                              const Progress& progress)
{
  return GlobalAligner(input, options).run(progress);
}
} // namespace fresco::registration
