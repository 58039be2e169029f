// SPDX-License-Identifier: BSD-3-Clause
#include "graph/alias_check.h"
#include "scan/lists.h"
#include <algorithm>
#include <atomic>
namespace fresco::registration {
namespace {
// A relative pose of two clusters by a hypothesis of one pair: half of a chain.
struct ChainLink {
  Index from, to; // clusters
  Eigen::Isometry3d T_from_to;
};
using ChainLinks = std::vector<ChainLink, Eigen::aligned_allocator<ChainLink>>;

// Hypotheses that stand comparison with the best of their pair.
VerifiedHypotheses soundHypotheses(const PairAlignment& pair)
{
  double overlap = 0.0, violation = 1.0;
  for (const VerifiedHypothesis& hypothesis : pair.hypotheses)
    overlap = std::max(overlap, hypothesis.check.overlap);
  for (const VerifiedHypothesis& hypothesis : pair.hypotheses)
    if (hypothesis.check.overlap > chance_share * overlap)
      violation = std::min(violation, hypothesis.check.violation);
  VerifiedHypotheses sound;
  for (const VerifiedHypothesis& hypothesis : pair.hypotheses)
    if (hypothesis.check.overlap > chance_share * overlap && !clearlyWorse(hypothesis.check.violation, violation))
      sound.push_back(hypothesis);
  return sound;
}

// Whether a pose of a second cluster in the first one is another place than that of a join.
bool isElsewhere(const GraphInput& input, const ScanCluster& first, const Eigen::Isometry3d& T,
                 const Eigen::Isometry3d& joined)
{
  const double size = input.scans[first.scans[0]].size;
  return poseDistance(T, joined, size) >= std::max<double>(3.0 * input.options.tolerance, 0.5 * size);
}

class ChainCheck {
public:
  ChainCheck(const GraphInput& input, const std::vector<ScanCluster>& clusters, const ClusterJoin& join)
      : input_(input), clusters_(clusters), join_(join)
  {}

  bool run() const;

private:
  ChainLinks linksFrom(Index cluster) const;
  bool isAlias(const ChainLink& out, const ChainLink& back) const;
  double violation(Index first, Index second, const Eigen::Isometry3d& T) const
  {
    return worstViolation(input_, clusters_[first], clusters_[second], T);
  }

  const GraphInput& input_;
  const std::vector<ScanCluster>& clusters_;
  const ClusterJoin& join_;
};

// To clusters other than the two to be joined. Scans without free space cannot speak for an alias.
ChainLinks ChainCheck::linksFrom(Index cluster) const
{
  constexpr double least_overlap = 0.3; // of a link / of the join: less is no evidence against it
  const std::vector<ClusterPlace> places = placesOf(clusters_, input_.scans.size());
  ChainLinks links;
  for (const PairAlignment& pair : input_.pairs) {
    const ClusterPlace &a = places[pair.a], &b = places[pair.b];
    const Index far = a.cluster == cluster ? b.cluster : a.cluster;
    if ((a.cluster != cluster && b.cluster != cluster) || far == join_.first || far == join_.second ||
        input_.scans[pair.a].free_space.empty() || input_.scans[pair.b].free_space.empty())
      continue;
    for (const VerifiedHypothesis& hypothesis : soundHypotheses(pair)) {
      const Eigen::Isometry3d T =
          clusters_[a.cluster].poses[a.position] * hypothesis.T_a_b * clusters_[b.cluster].poses[b.position].inverse();
      if (hypothesis.check.overlap > least_overlap * join_.overlap &&
          hypothesis.check.violation <= input_.most_violation) // a link that cannot be joined says nothing
        links.push_back({cluster, far, a.cluster == cluster ? T : Eigen::Isometry3d(T.inverse())});
    }
  }
  return links;
}

// Whether the chain over the third cluster leads to a place that free space does not rule out more than that of the
// join.
bool ChainCheck::isAlias(const ChainLink& out, const ChainLink& back) const
{
  const Eigen::Isometry3d T = out.T_from_to * back.T_from_to.inverse();
  if (!isElsewhere(input_, clusters_[join_.first], T, join_.T_first_second))
    return false;
  const double there = std::max({violation(join_.first, join_.second, T), violation(join_.first, out.to, out.T_from_to),
                                 violation(join_.second, out.to, back.T_from_to)});
  if (there > input_.options.max_violation)
    return false;
  // With the join, the third cluster can hold to one of its two links.
  const Eigen::Isometry3d T_second_first = join_.T_first_second.inverse();
  const double here = std::max(violation(join_.first, join_.second, join_.T_first_second),
                               std::min(violation(join_.second, out.to, T_second_first * out.T_from_to),
                                        violation(join_.first, out.to, join_.T_first_second * back.T_from_to)));
  return !clearlyWorse(there, here);
}

bool ChainCheck::run() const
{
  const ChainLinks out = linksFrom(join_.first), back = linksFrom(join_.second);
  for (const ChainLink& first : out)
    for (const ChainLink& second : back)
      if (first.to == second.to && isAlias(first, second))
        return true;
  return false;
}

// Motions of a cluster by the certain aliases of its scans, in its frame.
IsometryVector aliasMotions(const GraphInput& input, const ScanCluster& cluster)
{
  IsometryVector motions;
  for (std::size_t k = 0; k < cluster.scans.size(); ++k)
    for (const ScanAlias& alias : input.scans[cluster.scans[k]].aliases)
      if (alias.certain)
        for (const Eigen::Isometry3d& S : {alias.T, alias.T.inverse()})
          motions.push_back(cluster.poses[k] * S * cluster.poses[k].inverse());
  return motions;
}
} // namespace

double worstViolation(const GraphInput& input, const ScanCluster& first, const ScanCluster& second,
                      const Eigen::Isometry3d& T_first_second)
{
  const Index n = first.scans.size(), m = second.scans.size();
  std::atomic<bool> too_large{false};
  const std::vector<double> violations = mapTasks(n * m, input.options.threads, [&](Index k) {
    if (too_large)
      return 0.0;
    const Index i = k / m, j = k % m;
    const Eigen::Isometry3d T_a_b = first.poses[i].inverse() * T_first_second * second.poses[j];
    const double violation =
        pairViolation(input.scans[first.scans[i]], input.scans[second.scans[j]], T_a_b, check_level);
    if (violation > input.options.max_violation)
      too_large = true;
    return violation;
  });
  return *std::max_element(violations.begin(), violations.end());
}

bool hasAliasByChain(const GraphInput& input, const std::vector<ScanCluster>& clusters, const ClusterJoin& join)
{
  return ChainCheck(input, clusters, join).run();
}

bool hasAliasByScan(const GraphInput& input, const ScanCluster& first, const ScanCluster& second,
                    const Eigen::Isometry3d& T_first_second)
{
  IsometryVector elsewhere;
  for (const Eigen::Isometry3d& motion : aliasMotions(input, first))
    elsewhere.push_back(motion * T_first_second);
  for (const Eigen::Isometry3d& motion : aliasMotions(input, second))
    elsewhere.push_back(T_first_second * motion);
  if (elsewhere.empty())
    return false;
  const double here = worstViolation(input, first, second, T_first_second);
  return std::any_of(elsewhere.begin(), elsewhere.end(), [&](const Eigen::Isometry3d& T) {
    if (!isElsewhere(input, first, T, T_first_second))
      return false;
    const double there = worstViolation(input, first, second, T);
    return there <= input.options.max_violation && !clearlyWorse(there, here);
  });
}
} // namespace fresco::registration
