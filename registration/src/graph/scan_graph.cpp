// SPDX-License-Identifier: BSD-3-Clause
#include "graph/scan_graph.h"
#include "graph/alias_check.h"
#include <algorithm>
#include <cmath>
namespace fresco::registration {
namespace {
constexpr double telling_color = 0.6;     // correlation of colours that the upper quarter of the pairs reaches: then
constexpr double color_share = 0.5;       // a pair must reach this share of it
constexpr double plain_violation = 0.01;  // of scans of one state of a place: what moves or is misread,
constexpr double violation_factor = 10.0; // or this multiple of what the best quarter of the pairs has

struct Place {
  std::size_t cluster = 0, position = 0;
};

struct Candidate {
  const PairAlignment* pair;
  const PairMode* mode;
};

class GraphBuilder {
public:
  GraphBuilder(const std::vector<PreparedScan>& scans, const std::vector<PairAlignment>& pairs,
               const ScanCluster& known, const GraphOptions& options)
      : scans_(scans), pairs_(pairs), options_(options), known_count_(known.scans.size()), least_color_(leastColor()),
        plain_violation_(plainViolation())
  {
    if (known_count_ > 0)
      graph_.clusters.push_back(known);
    for (std::size_t i = 0; i < scans.size(); ++i)
      if (scans[i].problem.empty() &&
          std::find(known.scans.begin(), known.scans.end(), static_cast<Index>(i)) == known.scans.end())
        graph_.clusters.push_back({{static_cast<Index>(i)}, {Eigen::Isometry3d::Identity()}});
  }

  ScanGraph build();

private:
  Place placeOf(Index scan) const;
  const Eigen::Isometry3d& pose(const Place& place) const
  {
    return graph_.clusters[place.cluster].poses[place.position];
  }
  double slack() const { return 3.0 * options_.tolerance; }
  bool supported(const Candidate& candidate, const Eigen::Isometry3d& T_first_second) const;
  bool contradicted(const ScanCluster& first, const ScanCluster& second, const Eigen::Isometry3d& T_first_second) const;
  bool tryJoin(const Candidate& candidate);
  Eigen::Isometry3d clusterPose(const Candidate& candidate) const;
  void join(const Candidate& candidate, const Eigen::Isometry3d& T_a_b);
  double leastColor() const;
  double plainViolation() const;
  bool doubtful(const PairMode& mode) const { return mode.check.violation > plain_violation_; }
  bool unconvincing(const Candidate& candidate) const;
  bool joinUnambiguous();
  bool joinAmbiguous();
  void markLookAlikes();

  const std::vector<PreparedScan>& scans_;
  const std::vector<PairAlignment>& pairs_;
  const GraphOptions& options_;
  std::size_t known_count_;
  double least_color_, plain_violation_;
  std::vector<const PairAlignment*> contested_;
  ScanGraph graph_;
};

Place GraphBuilder::placeOf(Index scan) const
{
  for (std::size_t c = 0; c < graph_.clusters.size(); ++c) {
    const std::vector<Index>& members = graph_.clusters[c].scans;
    const auto found = std::find(members.begin(), members.end(), scan);
    if (found != members.end())
      return {c, static_cast<std::size_t>(found - members.begin())};
  }
  return {};
}

// Frame of the cluster of a from frame of the cluster of b.
Eigen::Isometry3d GraphBuilder::clusterPose(const Candidate& candidate) const
{
  return pose(placeOf(candidate.pair->a)) * candidate.mode->T_a_b * pose(placeOf(candidate.pair->b)).inverse();
}

// Whether both scans fit to themselves at a wrong place about as well as to each other.
bool GraphBuilder::unconvincing(const Candidate& candidate) const
{
  double likeness = 1.0;
  for (const Index scan : {candidate.pair->a, candidate.pair->b}) {
    double most = 0.0;
    for (const SelfMotion& motion : scans_[scan].twins)
      most = std::max(most, motion.likeness);
    likeness = std::min(likeness, most);
  }
  const PairCheck& check = candidate.mode->check;
  return likeness > 0.0 && (check.overlap < likeness || clearlyWorse(check.violation, 0.0));
}

// Whether a second pair between the same clusters says the same.
bool GraphBuilder::supported(const Candidate& candidate, const Eigen::Isometry3d& T_first_second) const
{
  const std::size_t first = placeOf(candidate.pair->a).cluster, second = placeOf(candidate.pair->b).cluster;
  const bool only_best = unconvincing(candidate);
  for (const PairAlignment& pair : pairs_) {
    const std::size_t a = placeOf(pair.a).cluster, b = placeOf(pair.b).cluster;
    if (&pair == candidate.pair || !((a == first && b == second) || (a == second && b == first)))
      continue;
    for (const PairMode& mode : pair.modes) {
      // What another pair holds merely possible does not make an unconvincing one certain.
      if (doubtful(mode) || (only_best && &mode != &pair.modes[0]))
        continue;
      const Eigen::Isometry3d T = clusterPose({&pair, &mode});
      if (poseDistance(a == first ? T : T.inverse(), T_first_second, scans_[pair.a].size) < slack())
        return true;
    }
  }
  return false;
}

bool GraphBuilder::contradicted(const ScanCluster& first, const ScanCluster& second,
                                const Eigen::Isometry3d& T_first_second) const
{
  return worstViolation(scans_, first, second, T_first_second, options_.threads) > options_.max_violation;
}

// The frame of the cluster that stands first stays.
void GraphBuilder::join(const Candidate& candidate, const Eigen::Isometry3d& T_a_b)
{
  const std::size_t a = placeOf(candidate.pair->a).cluster, b = placeOf(candidate.pair->b).cluster;
  ScanCluster &first = graph_.clusters[std::min(a, b)], &second = graph_.clusters[std::max(a, b)];
  const Eigen::Isometry3d T_first_second = a < b ? T_a_b : T_a_b.inverse();
  for (std::size_t k = 0; k < second.scans.size(); ++k) {
    first.scans.push_back(second.scans[k]);
    first.poses.push_back(T_first_second * second.poses[k]);
  }
  graph_.clusters.erase(graph_.clusters.begin() + static_cast<std::ptrdiff_t>(std::max(a, b)));
}

bool GraphBuilder::tryJoin(const Candidate& candidate)
{
  const std::size_t a = placeOf(candidate.pair->a).cluster, b = placeOf(candidate.pair->b).cluster;
  if (a == b)
    return false;
  const Eigen::Isometry3d T = clusterPose(candidate);
  const bool unsure = unconvincing(candidate);
  const bool weak = candidate.mode->support < options_.strong_overlap || doubtful(*candidate.mode) || unsure;
  if (weak && !supported(candidate, T)) {
    if (unsure)
      contested_.push_back(candidate.pair);
    return false;
  }
  if (contradicted(graph_.clusters[a], graph_.clusters[b], T))
    return false;
  const ClusterJoin proposed{a, b, T, candidate.mode->check.overlap};
  if (isContested(scans_, pairs_, graph_.clusters, proposed, options_) ||
      hasTwin(scans_, graph_.clusters, proposed, options_)) {
    contested_.push_back(candidate.pair);
    return false;
  }
  join(candidate, T);
  return true;
}

// Where most pairs agree well in colour, one that does not is a look-alike.
double GraphBuilder::leastColor() const
{
  std::vector<double> colors;
  for (const PairAlignment& pair : pairs_)
    if (!pair.modes.empty() && pair.modes[0].check.color)
      colors.push_back(*pair.modes[0].check.color);
  if (colors.empty())
    return -1.0;
  const auto upper = colors.begin() + static_cast<std::ptrdiff_t>(3 * colors.size() / 4);
  std::nth_element(colors.begin(), upper, colors.end());
  return *upper > telling_color ? color_share * *upper : -1.0;
}

// Where most pairs contradict free space hardly at all, one that does is a look-alike or has seen a change.
double GraphBuilder::plainViolation() const
{
  std::vector<double> violations;
  for (const PairAlignment& pair : pairs_)
    if (!pair.modes.empty() && !pair.ambiguous)
      violations.push_back(pair.modes[0].check.violation);
  if (violations.empty())
    return plain_violation;
  const auto lower = violations.begin() + static_cast<std::ptrdiff_t>((violations.size() - 1) / 4);
  std::nth_element(violations.begin(), lower, violations.end());
  return std::max(plain_violation, violation_factor * *lower);
}

bool GraphBuilder::joinUnambiguous()
{
  std::vector<Candidate> candidates;
  for (const PairAlignment& pair : pairs_)
    if (!pair.modes.empty() && !pair.ambiguous && pair.modes[0].check.color.value_or(1.0) >= least_color_)
      candidates.push_back({&pair, &pair.modes[0]});
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& x, const Candidate& y) { return x.mode->score > y.mode->score; });
  bool joined = false;
  for (const Candidate& candidate : candidates)
    joined = tryJoin(candidate) || joined;
  return joined;
}

// A pair of whose modes the other scans rule out all but one is not ambiguous any more.
bool GraphBuilder::joinAmbiguous()
{
  for (const PairAlignment& pair : pairs_) {
    const std::size_t a = placeOf(pair.a).cluster, b = placeOf(pair.b).cluster;
    if (!pair.ambiguous || a == b)
      continue;
    std::vector<std::pair<double, Candidate>> left;
    for (const PairMode& mode : pair.modes) {
      const Candidate candidate{&pair, &mode};
      const double violation =
          worstViolation(scans_, graph_.clusters[a], graph_.clusters[b], clusterPose(candidate), options_.threads);
      if (mode.check.color.value_or(1.0) >= least_color_ && violation <= options_.max_violation)
        left.emplace_back(violation, candidate);
    }
    std::stable_sort(left.begin(), left.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
    if (!left.empty() && (left.size() == 1 || clearlyWorse(left[1].first, left[0].first)) && tryJoin(left[0].second))
      return true;
  }
  return false;
}

// Clusters that stayed apart although pairs between them fit.
void GraphBuilder::markLookAlikes()
{
  for (const PairAlignment& pair : pairs_) {
    const std::size_t a = placeOf(pair.a).cluster, b = placeOf(pair.b).cluster;
    const bool contested = std::find(contested_.begin(), contested_.end(), &pair) != contested_.end();
    if (a != b && !pair.modes.empty() && (pair.ambiguous || contested))
      graph_.clusters[a].look_alike = graph_.clusters[b].look_alike = true;
  }
}

ScanGraph GraphBuilder::build()
{
  while (joinUnambiguous() || joinAmbiguous())
    ;
  markLookAlikes();
  std::stable_sort(graph_.clusters.begin() + (known_count_ > 0 ? 1 : 0), graph_.clusters.end(),
                   [](const ScanCluster& x, const ScanCluster& y) { return x.scans.size() > y.scans.size(); });
  return std::move(graph_);
}
} // namespace

ScanGraph buildScanGraph(const std::vector<PreparedScan>& scans, const std::vector<PairAlignment>& pairs,
                         const ScanCluster& known, const GraphOptions& options)
{
  return GraphBuilder(scans, pairs, known, options).build();
}
} // namespace fresco::registration
