// SPDX-License-Identifier: BSD-3-Clause
#include "graph/global_alignment.h"
#include "graph/pose_graph.h"
#include "scan/self_alignment.h"
#include <algorithm>
#include <fresco/core/parallel.h>
namespace fresco::registration {
namespace {
constexpr Index quick_features = 300; // the most distinctive ones, for the ranking of pairs
constexpr std::size_t all_pairs = 30; // up to this many pairs are tried without ranking
constexpr Index partners_a_round = 4; // of each scan
constexpr int most_rounds = 6;
constexpr double narrow_view = 0.4; // share of the sphere: a scanner that saw more stood where it is said to have stood
constexpr double edge_reach = 6.0;  // tolerances between a pair and the poses of its cluster: beyond, it is wrong
constexpr int fewest_pairs = 2;     // that must speak of a viewpoint
constexpr double blamed_share = 0.25; // of max_violation: mean violation from which a viewpoint is wrong, and
constexpr double blamed_wide = 2.0;   // the same of a scanner of wide view: it must contradict nearly all it meets

struct RankedPair {
  Index a, b;
  Index votes;
};

bool isKnown(const ScanCluster& known, Index scan)
{
  return std::find(known.scans.begin(), known.scans.end(), scan) != known.scans.end();
}

std::vector<RankedPair> possiblePairs(const std::vector<PreparedScan>& scans, const ScanCluster& known)
{
  std::vector<RankedPair> pairs;
  const auto usable = [&](Index i) { return scans[i].problem.empty(); };
  for (Index a = 0; a < static_cast<Index>(scans.size()); ++a)
    for (Index b = a + 1; b < static_cast<Index>(scans.size()); ++b)
      if (usable(a) && usable(b) && !(isKnown(known, a) && isKnown(known, b)))
        pairs.push_back({a, b, 0});
  return pairs;
}

ScanFeatures mostDistinctive(const ScanFeatures& features)
{
  const Index n = std::min(quick_features, features.points.cols());
  return {features.points.leftCols(n), features.normals.leftCols(n), features.descriptors.leftCols(n)};
}

void rankPairs(std::vector<RankedPair>& pairs, const std::vector<PreparedScan>& scans,
               const std::vector<ScanFeatures>& features, int threads)
{
  std::vector<ScanFeatures> few;
  for (const ScanFeatures& all : features)
    few.push_back(mostDistinctive(all));
  parallelFor(
      pairs.size(), threads,
      [&](Index k) {
        RankedPair& pair = pairs[k];
        const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
        ConsensusOptions options;
        options.tolerance = 1.5f * scans[a].levels[1].voxel;
        options.size = static_cast<float>(scans[a].size);
        options.most = 1;
        const Hypotheses best = findConsensus(few[a], few[b], matchFeatures(few[a], few[b], 400), options);
        pair.votes = best.empty() ? 0 : best[0].votes;
      },
      1);
  std::stable_sort(pairs.begin(), pairs.end(), [](const auto& x, const auto& y) { return x.votes > y.votes; });
}

// The best pairs not yet tried, at most `partners_a_round` of each scan; they are taken out of `pairs`.
std::vector<RankedPair> takeRound(std::vector<RankedPair>& pairs, std::size_t scan_count)
{
  std::vector<Index> taken(scan_count, 0);
  std::vector<RankedPair> round, rest;
  for (const RankedPair& pair : pairs) {
    Index &a = taken[pair.a], &b = taken[pair.b];
    const bool take = std::min(a, b) < partners_a_round;
    (take ? round : rest).push_back(pair);
    a += take ? 1 : 0;
    b += take ? 1 : 0;
  }
  pairs = std::move(rest);
  return round;
}

class GlobalAligner {
public:
  GlobalAligner(std::vector<PreparedScan>& scans, const ScanCluster& known, const ScanRegistrationOptions& options)
      : scans_(scans), known_(known), options_(options)
  {}

  GlobalAlignment run(const Progress& progress);

private:
  void describe(const Progress& progress);
  void alignPairs(const std::vector<RankedPair>& round);
  std::vector<char> wrongViewpoints() const;
  void correctViewpoints();
  void closeLoops(ScanCluster& cluster) const;
  GraphOptions graphOptions() const;

  std::vector<PreparedScan>& scans_;
  const ScanCluster& known_;
  const ScanRegistrationOptions& options_;
  std::vector<ScanFeatures> features_;
  GlobalAlignment result_;
};

void GlobalAligner::describe(const Progress& progress)
{
  FeatureOptions options;
  options.threads = options_.threads;
  for (std::size_t i = 0; i < scans_.size(); ++i) {
    report(progress, "describe", 0.3 * static_cast<double>(i) / static_cast<double>(scans_.size()));
    features_.push_back(scans_[i].problem.empty() ? describeScan(scans_[i], options) : ScanFeatures{});
  }
  parallelFor(
      scans_.size(), options_.threads,
      [&](Index k) {
        PreparedScan& scan = scans_[k];
        scan.twins = findSelfMotions(scan, features_[k]);
      },
      1);
}

void GlobalAligner::alignPairs(const std::vector<RankedPair>& round)
{
  PairAlignmentOptions options;
  options.min_overlap = options_.min_overlap;
  options.max_violation = options_.max_violation;
  options.upright = options_.upright;
  std::vector<PairAlignment> aligned(round.size());
  parallelFor(
      round.size(), options_.threads,
      [&](Index k) {
        const auto a = static_cast<std::size_t>(round[k].a);
        const auto b = static_cast<std::size_t>(round[k].b);
        PairAlignment& alignment = aligned[k];
        alignment = alignPair(scans_[a], scans_[b], features_[a], features_[b], options);
        alignment.a = static_cast<Index>(a);
        alignment.b = static_cast<Index>(b);
      },
      1);
  result_.pairs.insert(result_.pairs.end(), aligned.begin(), aligned.end());
  std::sort(result_.pairs.begin(), result_.pairs.end(),
            [](const PairAlignment& x, const PairAlignment& y) { return std::pair(x.a, x.b) < std::pair(y.a, y.b); });
}

// Scans whose free space contradicts what many features agree on.
std::vector<char> GlobalAligner::wrongViewpoints() const
{
  std::vector<double> violations(scans_.size(), 0.0);
  std::vector<int> counts(scans_.size(), 0);
  for (const PairAlignment& pair : result_.pairs) {
    const PairModes& modes = pair.refuted.empty() ? pair.modes : pair.refuted;
    if (modes.empty() || modes[0].votes < many_votes)
      continue;
    const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
    violations[a] += modes[0].check.violation_a;
    violations[b] += modes[0].check.violation_b;
    ++counts[a];
    ++counts[b];
  }
  std::vector<char> wrong(scans_.size(), 0), narrow(scans_.size(), 0);
  std::ptrdiff_t known_wrong = 0;
  for (std::size_t i = 0; i < scans_.size(); ++i) {
    narrow[i] = !scans_[i].free_space.empty() && scans_[i].free_space.coverage() < narrow_view;
    known_wrong += scans_[i].problem.empty() && scans_[i].free_space.empty() ? 1 : 0;
    const double share = narrow[i] ? blamed_share : blamed_wide;
    wrong[i] = !scans_[i].free_space.empty() && counts[i] >= fewest_pairs &&
               violations[i] > counts[i] * share * options_.max_violation;
  }
  // Where most are wrong, the rest comes from the same source.
  known_wrong += std::count(wrong.begin(), wrong.end(), 1);
  if (2 * known_wrong > static_cast<std::ptrdiff_t>(scans_.size()))
    for (std::size_t i = 0; i < scans_.size(); ++i)
      wrong[i] = wrong[i] || narrow[i];
  return wrong;
}

// Aligns the pairs of scans with wrong viewpoints again, without their free space.
void GlobalAligner::correctViewpoints()
{
  FeatureOptions features;
  features.threads = options_.threads;
  for (std::vector<char> wrong = wrongViewpoints(); std::find(wrong.begin(), wrong.end(), 1) != wrong.end();
       wrong = wrongViewpoints()) {
    for (std::size_t i = 0; i < scans_.size(); ++i)
      if (wrong[i]) {
        distrustViewpoint(scans_[i]);
        features_[i] = describeScan(scans_[i], features);
      }
    std::vector<RankedPair> again;
    std::vector<PairAlignment> kept;
    for (const PairAlignment& pair : result_.pairs)
      if (wrong[pair.a] || wrong[pair.b])
        again.push_back({pair.a, pair.b, 0});
      else
        kept.push_back(pair);
    result_.pairs = kept;
    alignPairs(again);
  }
}

// Joining used one pair at a time; all pairs between the cluster's scans that tell of its poses have a say.
void GlobalAligner::closeLoops(ScanCluster& cluster) const
{
  const auto position = [&](Index scan) {
    return std::find(cluster.scans.begin(), cluster.scans.end(), scan) - cluster.scans.begin();
  };
  const Index n = cluster.scans.size();
  PoseGraphOptions options;
  options.size = scans_[cluster.scans[0]].size;
  options.tolerance = graphOptions().tolerance;
  for (const Index scan : cluster.scans)
    options.fixed.push_back(isKnown(known_, scan));
  if (std::find(options.fixed.begin(), options.fixed.end(), 1) == options.fixed.end())
    options.fixed[0] = 1;
  PoseEdges edges;
  for (const PairAlignment& pair : result_.pairs) {
    const Index a = position(pair.a), b = position(pair.b);
    if (a == n || b == n)
      continue;
    const Eigen::Isometry3d T = cluster.poses[a].inverse() * cluster.poses[b];
    for (const PairMode& mode : pair.modes)
      if (poseDistance(T, mode.T_a_b, options.size) < edge_reach * options.tolerance)
        edges.push_back({a, b, mode.T_a_b, mode.support});
  }
  cluster.poses = optimizePoseGraph(cluster.poses, edges, options);
}

GraphOptions GlobalAligner::graphOptions() const
{
  GraphOptions options;
  options.max_violation = options_.max_violation;
  options.tolerance = 4.f * options_.voxel;
  options.threads = options_.threads;
  return options;
}

GlobalAlignment GlobalAligner::run(const Progress& progress)
{
  describe(progress);
  std::vector<RankedPair> pairs = possiblePairs(scans_, known_);
  const bool ranked = pairs.size() > all_pairs;
  if (ranked)
    rankPairs(pairs, scans_, features_, options_.threads);
  for (int round = 0; round < most_rounds; ++round) {
    report(progress, "align pairs", 0.3 + 0.7 * round / most_rounds);
    alignPairs(ranked ? takeRound(pairs, scans_.size()) : pairs);
    correctViewpoints();
    shareGlimpses(scans_, result_.pairs);
    result_.graph = buildScanGraph(scans_, result_.pairs, known_, graphOptions());
    if (!ranked || pairs.empty() || result_.graph.clusters.size() <= 1)
      break;
  }
  for (ScanCluster& cluster : result_.graph.clusters)
    closeLoops(cluster);
  return std::move(result_);
}
} // namespace

GlobalAlignment alignGlobally(std::vector<PreparedScan>& scans, const ScanCluster& known,
                              const ScanRegistrationOptions& options, const Progress& progress)
{
  return GlobalAligner(scans, known, options).run(progress);
}
} // namespace fresco::registration
