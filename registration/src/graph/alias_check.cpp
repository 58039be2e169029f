// SPDX-License-Identifier: BSD-3-Clause
#include "graph/alias_check.h"
#include <algorithm>
#include <fresco/core/parallel.h>
namespace fresco::registration {
namespace {
constexpr double leg_overlap = 0.3;  // of a leg / of the contested pair: less is no rival
constexpr double mode_overlap = 0.4; // of a mode / of the best mode of its pair

// A relative pose of two clusters by a mode of one pair.
struct Leg {
  std::size_t from, to; // clusters
  Eigen::Isometry3d T_from_to;
  double overlap, violation;
};
using Legs = std::vector<Leg, Eigen::aligned_allocator<Leg>>;

struct Place {
  std::size_t cluster = 0, position = 0;
};

std::vector<Place> placesOf(const std::vector<ScanCluster>& clusters, std::size_t scan_count)
{
  std::vector<Place> places(scan_count);
  for (std::size_t c = 0; c < clusters.size(); ++c)
    for (std::size_t k = 0; k < clusters[c].scans.size(); ++k)
      places[clusters[c].scans[k]] = {c, k};
  return places;
}

// Modes that stand comparison with the best of their pair.
PairModes soundModes(const PairAlignment& pair)
{
  double overlap = 0.0, violation = 1.0;
  for (const PairMode& mode : pair.modes)
    overlap = std::max(overlap, mode.check.overlap);
  for (const PairMode& mode : pair.modes)
    if (mode.check.overlap > mode_overlap * overlap)
      violation = std::min(violation, mode.check.violation);
  PairModes sound;
  for (const PairMode& mode : pair.modes)
    if (mode.check.overlap > mode_overlap * overlap && !clearlyWorse(mode.check.violation, violation))
      sound.push_back(mode);
  return sound;
}

class Contest {
public:
  Contest(const std::vector<PreparedScan>& scans, const std::vector<ScanCluster>& clusters, const ClusterJoin& join,
          const GraphOptions& options)
      : scans_(scans), clusters_(clusters), join_(join), options_(options)
  {}

  bool run(const std::vector<PairAlignment>& pairs);

private:
  Legs legsFrom(std::size_t cluster, const std::vector<PairAlignment>& pairs) const;
  bool rivals(const Leg& out, const Leg& back) const;
  double violation(std::size_t first, std::size_t second, const Eigen::Isometry3d& T) const
  {
    return worstViolation(scans_, clusters_[first], clusters_[second], T, options_.threads);
  }

  const std::vector<PreparedScan>& scans_;
  const std::vector<ScanCluster>& clusters_;
  const ClusterJoin& join_;
  const GraphOptions& options_;
};

// To clusters other than the two to be joined. Scans without free space cannot speak for a rival.
Legs Contest::legsFrom(std::size_t cluster, const std::vector<PairAlignment>& pairs) const
{
  const std::vector<Place> places = placesOf(clusters_, scans_.size());
  Legs legs;
  for (const PairAlignment& pair : pairs) {
    const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
    const std::size_t one = places[a].cluster, other = places[b].cluster, far = one == cluster ? other : one;
    if ((one != cluster && other != cluster) || far == join_.first || far == join_.second ||
        scans_[a].free_space.empty() || scans_[b].free_space.empty())
      continue;
    for (const PairMode& mode : soundModes(pair)) {
      const Eigen::Isometry3d T_one_other =
          clusters_[one].poses[places[a].position] * mode.T_a_b * clusters_[other].poses[places[b].position].inverse();
      if (mode.check.overlap > leg_overlap * join_.overlap)
        legs.push_back({cluster, far, one == cluster ? T_one_other : Eigen::Isometry3d(T_one_other.inverse()),
                        mode.check.overlap, mode.check.violation});
    }
  }
  return legs;
}

// Whether the way over the third cluster leads to a place that free space does not rule out more than that of the join.
bool Contest::rivals(const Leg& out, const Leg& back) const
{
  const Eigen::Isometry3d T = out.T_from_to * back.T_from_to.inverse();
  const double size = scans_[clusters_[join_.first].scans[0]].size;
  if (poseDistance(T, join_.T_first_second, size) < std::max<double>(3.0 * options_.tolerance, 0.5 * size))
    return false;
  const double there = std::max({violation(join_.first, join_.second, T), violation(join_.first, out.to, out.T_from_to),
                                 violation(join_.second, out.to, back.T_from_to)});
  if (there > options_.max_violation)
    return false;
  // With the join, the third cluster can hold to one of its two legs.
  const Eigen::Isometry3d T_second_first = join_.T_first_second.inverse();
  const double here = std::max(violation(join_.first, join_.second, join_.T_first_second),
                               std::min(violation(join_.second, out.to, T_second_first * out.T_from_to),
                                        violation(join_.first, out.to, join_.T_first_second * back.T_from_to)));
  return !clearlyWorse(there, here);
}

bool Contest::run(const std::vector<PairAlignment>& pairs)
{
  const Legs out = legsFrom(join_.first, pairs), back = legsFrom(join_.second, pairs);
  for (const Leg& first : out)
    for (const Leg& second : back)
      if (first.to == second.to && rivals(first, second))
        return true;
  return false;
}
} // namespace

double worstViolation(const std::vector<PreparedScan>& scans, const ScanCluster& first, const ScanCluster& second,
                      const Eigen::Isometry3d& T_first_second, int threads)
{
  const std::size_t n = first.scans.size(), m = second.scans.size();
  std::vector<double> violations(n * m, 0.0);
  parallelFor(
      n * m, threads,
      [&](Index k) {
        const std::size_t i = static_cast<std::size_t>(k) / m, j = static_cast<std::size_t>(k) % m;
        const PreparedScan& a = scans[first.scans[i]];
        const PreparedScan& b = scans[second.scans[j]];
        const Eigen::Isometry3d T_a_b = first.poses[i].inverse() * T_first_second * second.poses[j];
        violations[k] = checkPair(a, b, T_a_b, check_level).violation;
      },
      1);
  return *std::max_element(violations.begin(), violations.end());
}

bool isContested(const std::vector<PreparedScan>& scans, const std::vector<PairAlignment>& pairs,
                 const std::vector<ScanCluster>& clusters, const ClusterJoin& join, const GraphOptions& options)
{
  return Contest(scans, clusters, join, options).run(pairs);
}

bool hasTwin(const std::vector<PreparedScan>& scans, const std::vector<ScanCluster>& clusters, const ClusterJoin& join,
             const GraphOptions& options)
{
  const ScanCluster &first = clusters[join.first], &second = clusters[join.second];
  IsometryVector elsewhere;
  const auto collect = [&](const ScanCluster& cluster, bool is_first) {
    for (std::size_t k = 0; k < cluster.scans.size(); ++k)
      for (const SelfMotion& motion : scans[cluster.scans[k]].twins)
        if (motion.certain)
          for (const Eigen::Isometry3d& S : {motion.T, motion.T.inverse()}) {
            const Eigen::Isometry3d own = cluster.poses[k] * S * cluster.poses[k].inverse();
            elsewhere.push_back(is_first ? own * join.T_first_second : join.T_first_second * own);
          }
  };
  collect(first, true);
  collect(second, false);
  if (elsewhere.empty())
    return false;
  const double size = scans[first.scans[0]].size;
  const double here = worstViolation(scans, first, second, join.T_first_second, options.threads);
  return std::any_of(elsewhere.begin(), elsewhere.end(), [&](const Eigen::Isometry3d& T) {
    if (poseDistance(T, join.T_first_second, size) < std::max<double>(3.0 * options.tolerance, 0.5 * size))
      return false;
    const double there = worstViolation(scans, first, second, T, options.threads);
    return there <= options.max_violation && !clearlyWorse(there, here);
  });
}
} // namespace fresco::registration
