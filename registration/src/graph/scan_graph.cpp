// SPDX-License-Identifier: BSD-3-Clause
#include "graph/scan_graph.h"
#include "graph/alias_check.h"
#include "graph/cluster_poses.h"
#include "graph/free_space_evidence.h"
#include "graph/place_check.h"
#include "scan/lists.h"
#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
namespace fresco::registration {
namespace {
struct Candidate {
  const PairAlignment* pair;
  const VerifiedHypothesis* hypothesis;
};

class GraphBuilder {
public:
  GraphBuilder(const GraphInput& input, const ScanCluster& known)
      : input_(input), known_(known), judge_(input.scans), late_(input.scans.size(), 0)
  {}

  ScanGraph build();

private:
  void begin();
  bool setContestedAside();
  const Eigen::Isometry3d& pose(Index scan) const
  {
    return graph_.clusters[places_[scan].cluster].poses[places_[scan].position];
  }
  double slack() const { return 3.0 * input_.options.tolerance; }
  bool supported(const Candidate& candidate, const Eigen::Isometry3d& T_first_second) const;
  bool tryJoin(const Candidate& candidate);
  Eigen::Isometry3d clusterPose(const Candidate& candidate) const;
  void join(Index a, Index b, const Eigen::Isometry3d& T_a_b); // clusters
  bool doubtful(const PairAlignment& pair, const PairCheck& check) const
  {
    if (!sawAround(input_.scans[pair.a]) || !sawAround(input_.scans[pair.b]))
      return check.violation > input_.most_violation;
    return check.violation > noiseViolation() || contradictsOneRoom(check, input_.usual_violation);
  }
  double noiseViolation() const { return std::max(noise_violation, input_.usual_violation); }
  std::optional<Eigen::Isometry3d> fittingPose(Index a, Index b, const Eigen::Isometry3d& T_a_b) const;
  bool joinUnambiguous();
  bool joinAmbiguous();
  bool mostAgree(Index scan, const PairAlignment& candidate) const;
  bool joinBlind();
  bool joinUncontested();
  bool blind(const PairAlignment& pair) const { return input_.scans[pair.a].blind || input_.scans[pair.b].blind; }
  bool waits(const PairAlignment& pair) const { return blind(pair) || late_[pair.a] || late_[pair.b]; }
  void markLookAlikes();

  const GraphInput& input_;
  const ScanCluster& known_;
  const FreeSpaceJudge judge_;
  std::map<const PairAlignment*, RefusalReason> aliased_;
  std::vector<char> late_; // per scan
  ScanGraph graph_;
  std::vector<ClusterPlace> places_; // of all scans in graph_
};

void GraphBuilder::begin()
{
  aliased_.clear();
  graph_.clusters = startingClusters(input_, known_);
  places_ = placesOf(graph_.clusters, input_.scans.size());
}

// Scans that would fit elsewhere join last: another round is built without them.
bool GraphBuilder::setContestedAside()
{
  bool found = false;
  for (ScanCluster& cluster : graph_.clusters) {
    settle(input_, known_, cluster);
    for (const Index scan : contestedScans(input_, known_, cluster)) {
      late_[scan] = 1;
      found = true;
    }
  }
  return found;
}

// Frame of the cluster of a from frame of the cluster of b.
Eigen::Isometry3d GraphBuilder::clusterPose(const Candidate& candidate) const
{
  return pose(candidate.pair->a) * candidate.hypothesis->T_a_b * pose(candidate.pair->b).inverse();
}

// Whether a second pair between the same clusters says the same.
bool GraphBuilder::supported(const Candidate& candidate, const Eigen::Isometry3d& T_first_second) const
{
  const Index first = places_[candidate.pair->a].cluster, second = places_[candidate.pair->b].cluster;
  for (const PairAlignment& pair : input_.pairs) {
    const Index a = places_[pair.a].cluster, b = places_[pair.b].cluster;
    if (&pair == candidate.pair || !((a == first && b == second) || (a == second && b == first)))
      continue;
    for (const VerifiedHypothesis& hypothesis : pair.hypotheses) {
      if (doubtful(pair, hypothesis.check))
        continue;
      const Eigen::Isometry3d T = clusterPose({&pair, &hypothesis});
      if (poseDistance(a == first ? T : T.inverse(), T_first_second, input_.scans[pair.a].size) < slack())
        return true;
    }
  }
  return false;
}

// The frame of the cluster that stands first stays.
void GraphBuilder::join(Index a, Index b, const Eigen::Isometry3d& T_a_b)
{
  ScanCluster &first = graph_.clusters[std::min(a, b)], &second = graph_.clusters[std::max(a, b)];
  append(first, second, a < b ? T_a_b : T_a_b.inverse());
  graph_.clusters.erase(graph_.clusters.begin() + std::max(a, b));
  places_ = placesOf(graph_.clusters, input_.scans.size());
}

// T_a_b if no two scans of the clusters contradict each other. Of several scans true pairs do so where they looked through
// panes or something moved; then where the smaller cluster settles, if free space of all does not contradict it there.
std::optional<Eigen::Isometry3d> GraphBuilder::fittingPose(Index a, Index b, const Eigen::Isometry3d& T_a_b) const
{
  const ScanCluster &first = graph_.clusters[a], &second = graph_.clusters[b];
  if (worstViolation(input_, first, second, T_a_b) <= input_.most_violation)
    return T_a_b;
  if (first.scans.size() + second.scans.size() == 2)
    return std::nullopt;
  const bool first_moves = first.scans.size() < second.scans.size();
  const Eigen::Isometry3d T = first_moves ? settledPose(input_, second, first, T_a_b.inverse()).inverse()
                                          : settledPose(input_, first, second, T_a_b);
  return isClearlyContradicted(judge_.judge(first, second, T)) ? std::nullopt : std::optional(T);
}

bool GraphBuilder::tryJoin(const Candidate& candidate)
{
  const Index a = places_[candidate.pair->a].cluster, b = places_[candidate.pair->b].cluster;
  if (a == b)
    return false;
  Eigen::Isometry3d T = clusterPose(candidate);
  const bool weak =
      candidate.hypothesis->support < strong_overlap || doubtful(*candidate.pair, candidate.hypothesis->check);
  if (weak && !supported(candidate, T))
    return false;
  const std::optional<Eigen::Isometry3d> fitting = fittingPose(a, b, T);
  if (!fitting)
    return false;
  T = *fitting;
  const ScanCluster &first = graph_.clusters[a], &second = graph_.clusters[b];
  const bool single = first.scans.size() == 1 || second.scans.size() == 1; // of which contestedScans() will tell
  const bool by_scan = hasAliasByScan(input_, first, second, T);
  if (by_scan || (!single && isContested(input_, first, second, T))) {
    aliased_[candidate.pair] = by_scan ? RefusalReason::repeats : RefusalReason::second_place;
    return false;
  }
  join(a, b, T);
  return true;
}

bool GraphBuilder::joinUnambiguous()
{
  std::vector<Candidate> candidates;
  for (const PairAlignment& pair : input_.pairs)
    if (!pair.hypotheses.empty() && !pair.ambiguous && !waits(pair) &&
        pair.hypotheses[0].check.color.value_or(1.0) >= input_.least_color)
      candidates.push_back({&pair, &pair.hypotheses[0]});
  sortFalling(candidates, [](const Candidate& candidate) { return candidate.hypothesis->score; });
  bool joined = false;
  for (const Candidate& candidate : candidates)
    joined = tryJoin(candidate) || joined;
  return joined;
}

// A pair of whose hypotheses the other scans rule out all but one is not ambiguous any more.
bool GraphBuilder::joinAmbiguous()
{
  for (const PairAlignment& pair : input_.pairs) {
    const Index a = places_[pair.a].cluster, b = places_[pair.b].cluster;
    if (!pair.ambiguous || a == b || waits(pair))
      continue;
    std::vector<std::pair<double, Candidate>> left;
    for (const VerifiedHypothesis& hypothesis : pair.hypotheses) {
      const Candidate candidate{&pair, &hypothesis};
      const double violation = worstViolation(input_, graph_.clusters[a], graph_.clusters[b], clusterPose(candidate));
      if (hypothesis.check.color.value_or(1.0) >= input_.least_color && violation <= input_.options.max_violation)
        left.emplace_back(violation, candidate);
    }
    std::stable_sort(left.begin(), left.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
    if (!left.empty() && (left.size() == 1 || clearlyWorse(left[1].first, left[0].first)) && tryJoin(left[0].second))
      return true;
  }
  return false;
}

// Whether most pairs of a scan, and two at least, see it where the candidate does.
bool GraphBuilder::mostAgree(Index scan, const PairAlignment& candidate) const
{
  const auto partner = [&](const PairAlignment& pair) { return pair.a == scan ? pair.b : pair.a; };
  const auto seen = [&](const PairAlignment& pair) {
    const Eigen::Isometry3d& T = pair.hypotheses[0].T_a_b;
    return Eigen::Isometry3d(pose(partner(pair)) * (pair.a == scan ? T.inverse() : T));
  };
  Index agree = 0, others = 0;
  for (const PairAlignment* pair : input_.pairs_of[scan]) {
    if (pair->hypotheses.empty() || input_.scans[partner(*pair)].blind)
      continue;
    const bool same = places_[partner(*pair)].cluster == places_[partner(candidate)].cluster &&
                      poseDistance(seen(*pair), seen(candidate), input_.scans[scan].size) < slack();
    (same ? agree : others) += 1;
  }
  return agree >= fewest_pairs && agree > others;
}

// Scans that know nothing of free space join last, one at a time, and hold no two others together.
bool GraphBuilder::joinBlind()
{
  for (const PairAlignment& pair : input_.pairs) {
    const Index scan = input_.scans[pair.a].blind ? pair.a : pair.b;
    if (blind(pair) && !pair.hypotheses.empty() && graph_.clusters[places_[scan].cluster].scans.size() == 1 &&
        mostAgree(scan, pair) && tryJoin({&pair, &pair.hypotheses[0]}))
      return true;
  }
  return false;
}

// What is left joins where nothing else is in question for it: small clusters, of one scan mostly, to larger ones.
bool GraphBuilder::joinUncontested()
{
  std::vector<Index> order(graph_.clusters.size());
  std::iota(order.begin(), order.end(), Index(0));
  const auto size = [&](Index c) { return graph_.clusters[c].scans.size(); };
  sortFalling(order, size);
  for (std::size_t i = 0; i < order.size() && size(order[i]) > 1; ++i)
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      if (input_.scans[graph_.clusters[order[j]].scans[0]].blind)
        continue;
      const ClusterPoses places = findPlaces(input_, graph_.clusters[order[i]], graph_.clusters[order[j]]);
      const ClusterPose* place = uncontested(places, strong_overlap, noiseViolation());
      if (place == nullptr)
        continue;
      join(order[i], order[j], place->T);
      settle(input_, known_, graph_.clusters[std::min(order[i], order[j])]);
      return true;
    }
  return false;
}

// Clusters that stayed apart although pairs between them fit.
void GraphBuilder::markLookAlikes()
{
  for (const PairAlignment& pair : input_.pairs) {
    const Index a = places_[pair.a].cluster, b = places_[pair.b].cluster;
    const auto aliased = aliased_.find(&pair);
    const bool contested = late_[pair.a] || late_[pair.b] || aliased != aliased_.end();
    if (a == b || blind(pair) || (contested ? pair.hypotheses.empty() : !pair.ambiguous || pair.hypotheses.size() < 2))
      continue;
    const RefusalReason reason = aliased == aliased_.end() ? RefusalReason::second_place : aliased->second;
    graph_.clusters[a].refusal = {reason, pair.b};
    graph_.clusters[b].refusal = {reason, pair.a};
  }
}

ScanGraph GraphBuilder::build()
{
  constexpr int most_rounds = 6; // bounds the time
  for (int round = 0; round < most_rounds; ++round) {
    begin();
    while (joinUnambiguous() || joinAmbiguous())
      ;
    if (!setContestedAside())
      break;
  }
  while (joinUncontested() || joinBlind())
    ;
  markLookAlikes();
  sortBySize(graph_.clusters, known_.scans.empty() ? 0 : 1);
  return std::move(graph_);
}
} // namespace

GraphInput::GraphInput(const std::vector<PreparedScan>& all, const std::vector<PairAlignment>& aligned,
                       const GraphOptions& given)
    : scans(all), pairs(aligned), pairs_of(all.size()), options(given), least_color(leastColor(pairs)),
      usual_violation(usualViolation(pairs)), most_violation(mostViolation(pairs, given.max_violation))
{
  for (const PairAlignment& pair : pairs)
    for (const Index scan : {pair.a, pair.b})
      pairs_of[scan].push_back(&pair);
}

std::vector<ScanCluster> startingClusters(const GraphInput& input, const ScanCluster& known)
{
  std::vector<ScanCluster> clusters;
  if (!known.scans.empty())
    clusters.push_back(known);
  const Index n = input.scans.size();
  for (Index i = 0; i < n; ++i)
    if (input.scans[i].problem.empty() && !contains(known, i))
      clusters.push_back({{i}, {Eigen::Isometry3d::Identity()}});
  return clusters;
}

ScanGraph buildScanGraph(const GraphInput& input, const ScanCluster& known)
{
  return GraphBuilder(input, known).build();
}
} // namespace fresco::registration
