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
                                            const Eigen::Isometry3d& T_seer_seen) const
{
  const ScanLevel& level = seen.levels[check_level];
  const Eigen::Isometry3f T = T_seer_seen.cast<float>();
  using Verdict = ScanFreeSpace::Verdict;
  const std::vector<Verdict> verdicts = judgeLevel(seer, level, T, Grazed::spared);
  Index agree = 0, violating = 0, clustered = 0;
  for (Index i = 0; i < level.points.cols(); ++i) {
    if (verdicts[i] == Verdict::unknown || !isNear(T * level.points.col(i)))
      continue;
    agree += verdicts[i] == Verdict::agrees ? 1 : 0;
    if (verdicts[i] != Verdict::violates)
      continue;
    ++violating;
    clustered += violatesWithNeighbours(level, verdicts, i) ? 1 : 0;
  }
  return {agree / unit_, violating / unit_, clustered / unit_, seer.spares_doubtful};
}

FreeSpaceEvidence FreeSpaceJudge::judge(Index a, Index b, const Eigen::Isometry3d& T_a_b) const
{
  FreeSpaceEvidence evidence;
  if (isOutOfReach(T_a_b))
    return evidence;
  evidence += judgeSeen(scans_[a], scans_[b], T_a_b);
  evidence += judgeSeen(scans_[b], scans_[a], T_a_b.inverse());
  return evidence;
}

FreeSpaceEvidence FreeSpaceJudge::judge(const ScanCluster& first, const ScanCluster& second,
                                        const Eigen::Isometry3d& T_first_second) const
{
  FreeSpaceEvidence evidence;
  for (std::size_t i = 0; i < first.scans.size(); ++i)
    for (std::size_t k = 0; k < second.scans.size(); ++k) {
      evidence += judge(first.scans[i], second.scans[k], first.poses[i].inverse() * T_first_second * second.poses[k]);
      if (isHopeless(evidence) && isContradicted(evidence))
        return evidence;
    }
  return evidence;
}

double FreeSpaceJudge::confirmedBy(const ScanCluster& seers, const PreparedScan& seen,
                                   const Eigen::Isometry3d& T_seers_seen) const
{
  const ScanLevel& level = seen.levels[check_level];
  std::vector<char> found(level.points.cols(), 0);
  for (std::size_t k = 0; k < seers.scans.size(); ++k) {
    const Eigen::Isometry3d T_seer_seen = seers.poses[k].inverse() * T_seers_seen;
    if (isOutOfReach(T_seer_seen))
      continue;
    const Eigen::Isometry3f T = T_seer_seen.cast<float>();
    const auto verdicts = judgeLevel(scans_[seers.scans[k]], level, T, Grazed::spared);
    for (Index i = 0; i < level.points.cols(); ++i)
      if (verdicts[i] == ScanFreeSpace::Verdict::agrees && isNear(T * level.points.col(i)))
        found[i] = 1;
  }
  return std::count(found.begin(), found.end(), 1) / unit_;
}

double FreeSpaceJudge::confirmed(const ScanCluster& first, const ScanCluster& second,
                                 const Eigen::Isometry3d& T_first_second) const
{
  double sum = 0.0;
  for (std::size_t i = 0; i < first.scans.size(); ++i)
    sum += confirmedBy(second, scans_[first.scans[i]], T_first_second.inverse() * first.poses[i]);
  for (std::size_t k = 0; k < second.scans.size(); ++k)
    sum += confirmedBy(first, scans_[second.scans[k]], T_first_second * second.poses[k]);
  return sum;
}
} // namespace fresco::registration
