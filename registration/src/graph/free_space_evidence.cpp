// SPDX-License-Identifier: BSD-3-Clause
#include "graph/free_space_evidence.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/statistics.h>
namespace fresco::registration {
namespace {
// What right places have at most, but for what moved.
double usualContradiction(const FreeSpaceEvidence& evidence)
{
  constexpr double stray = 0.0013; // of one scan's points: panes
  constexpr double usual = 0.0008; // of the points that agree: twice what right places have
  return stray + usual * evidence.agree;
}
} // namespace

FreeSpaceEvidence& FreeSpaceEvidence::operator+=(const FreeSpaceEvidence& other)
{
  agree += other.agree;
  violating += other.violating;
  clustered += other.clustered;
  confirmed += other.confirmed;
  crowded = crowded || other.crowded;
  return *this;
}

void refuse(ScanCluster& first, ScanCluster& second, RefusalReason reason, const FreeSpaceEvidence& evidence)
{
  for (const auto& [cluster, other] : {std::pair(&first, &second), std::pair(&second, &first)})
    if (cluster->refusal.reason == RefusalReason::none || cluster->refusal.agree < evidence.agree)
      cluster->refusal = {reason, other->scans[0], evidence.agree, evidence.clustered};
}

bool isContradicted(const FreeSpaceEvidence& evidence)
{
  return evidence.crowded ? isClearlyContradicted(evidence) : evidence.clustered > usualContradiction(evidence);
}

bool isHopeless(const FreeSpaceEvidence& evidence)
{
  constexpr double much = 0.1; // of one scan's points
  return evidence.clustered > much;
}

bool isClearlyContradicted(const FreeSpaceEvidence& evidence)
{
  constexpr double clearly = 1.5;
  return evidence.clustered > clearly * usualContradiction(evidence);
}

bool contradictsMore(const FreeSpaceEvidence& other, const FreeSpaceEvidence& here, double unit)
{
  // Points that violate lie together: their number varies as that of groups of so many.
  constexpr double clustered_group = 6.0, group = 3.0;
  const auto exceeds = [&](double more, double less, double size) {
    return unit * (more - less) > 3.0 * std::sqrt(size * unit * (more + less) + 9.0);
  };
  return exceeds(other.clustered, here.clustered, clustered_group) || exceeds(other.violating, here.violating, group);
}

FreeSpaceJudge::FreeSpaceJudge(const std::vector<PreparedScan>& scans) : scans_(scans)
{
  constexpr double ranges = 5.0; // beyond, few points say much and errors of rotations count
  std::vector<double> sizes;
  double points = 0.0;
  for (const PreparedScan& scan : scans)
    if (scan.problem.empty()) {
      sizes.push_back(scan.size);
      points += scan.levels[check_level].points.cols();
    }
  if (sizes.empty())
    return;
  unit_ = points / sizes.size();
  reach_ = ranges * median(sizes);
}

FreeSpaceEvidence FreeSpaceJudge::judgeSeen(const PreparedScan& seer, const PreparedScan& seen,
                                            const Eigen::Isometry3d& T_seer_seen, Marks& confirmed) const
{
  const ScanLevel& level = seen.levels[check_level];
  const Eigen::Isometry3f T = T_seer_seen.cast<float>();
  using Verdict = ScanFreeSpace::Verdict;
  const std::vector<Verdict> verdicts = judgeLevel(seer, level, T, Grazed::spared);
  confirmed.resize(verdicts.size(), 0);
  Index agree = 0, violating = 0, clustered = 0, fresh = 0;
  for (Index i = 0; i < level.points.cols(); ++i) {
    if (verdicts[i] == Verdict::unknown || !isNear(T * level.points.col(i)))
      continue;
    if (verdicts[i] == Verdict::agrees) {
      ++agree;
      fresh += confirmed[i] ? 0 : 1;
      confirmed[i] = 1;
    }
    if (verdicts[i] != Verdict::violates)
      continue;
    ++violating;
    clustered += violatesWithNeighbours(level, verdicts, i) ? 1 : 0;
  }
  return {agree / unit_, violating / unit_, clustered / unit_, fresh / unit_, seer.spares_doubtful};
}

FreeSpaceEvidence FreeSpaceJudge::judgePair(Index a, Index b, const Eigen::Isometry3d& T_a_b, Marks& confirmed_a,
                                            Marks& confirmed_b) const
{
  FreeSpaceEvidence evidence;
  if (isOutOfReach(T_a_b))
    return evidence;
  evidence += judgeSeen(scans_[a], scans_[b], T_a_b, confirmed_b);
  evidence += judgeSeen(scans_[b], scans_[a], T_a_b.inverse(), confirmed_a);
  return evidence;
}

FreeSpaceEvidence FreeSpaceJudge::judge(Index a, Index b, const Eigen::Isometry3d& T_a_b) const
{
  Marks confirmed_a, confirmed_b;
  return judgePair(a, b, T_a_b, confirmed_a, confirmed_b);
}

FreeSpaceEvidence FreeSpaceJudge::judge(const ScanCluster& first, const ScanCluster& second,
                                        const Eigen::Isometry3d& T_first_second) const
{
  FreeSpaceEvidence evidence;
  std::vector<Marks> of_first(first.scans.size()), of_second(second.scans.size());
  for (std::size_t i = 0; i < first.scans.size(); ++i)
    for (std::size_t k = 0; k < second.scans.size(); ++k) {
      evidence += judgePair(first.scans[i], second.scans[k],
                            first.poses[i].inverse() * T_first_second * second.poses[k], of_first[i], of_second[k]);
      if (isHopeless(evidence) && isContradicted(evidence))
        return evidence;
    }
  return evidence;
}
} // namespace fresco::registration
