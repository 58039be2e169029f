// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/scan_graph.h"
namespace fresco::registration {
/// What free space says of the relative pose of scans: numbers of points, over all pairs of scans and both directions, each
/// over the mean number of points of a scan.
struct FreeSpaceEvidence {
  double agree = 0.0;     ///< as deep as the other scan measured
  double violating = 0.0; ///< in space that the other saw through
  double clustered = 0.0; ///< of these, that lie there together with their neighbours: no mixed pixels
  double confirmed = 0.0; ///< as agree, but each point counted once, however many scans see it
  bool crowded = false;   ///< whether people moved between the scans, see PreparedScan::spares_doubtful
  FreeSpaceEvidence& operator+=(const FreeSpaceEvidence& other);
};

/// Notes at two clusters why they were not joined where so much agrees. What agrees most is kept.
void refuse(ScanCluster& first, ScanCluster& second, RefusalReason reason, const FreeSpaceEvidence& evidence);

/// Whether more points contradict a pose than mixed pixels and small errors of poses explain.
bool isContradicted(const FreeSpaceEvidence& evidence);

/// Whether so many do that no small motion mends it, nor other scans make up for it.
bool isHopeless(const FreeSpaceEvidence& evidence);

/// Whether half as many more do: something may have moved.
bool isClearlyContradicted(const FreeSpaceEvidence& evidence);

/// Whether `other` contradicts a place clearly more than `here` does its own: by three standard deviations of counts.
/// @param unit the mean number of points of a scan
bool contradictsMore(const FreeSpaceEvidence& other, const FreeSpaceEvidence& here, double unit);

/// Sums up the evidence of scans of a thinning; of every point counts what lies within five median ranges of a scanner.
class FreeSpaceJudge {
public:
  explicit FreeSpaceJudge(const std::vector<PreparedScan>& scans);
  double unit() const { return unit_; } ///< mean number of points of a scan

  FreeSpaceEvidence judge(Index a, Index b, const Eigen::Isometry3d& T_a_b) const;

  /// All scans of the first with all of the second; where much contradicts, only some of them.
  FreeSpaceEvidence judge(const ScanCluster& first, const ScanCluster& second,
                          const Eigen::Isometry3d& T_first_second) const;

private:
  using Marks = std::vector<char>; // of the points of a scan, which are confirmed; empty before the first is
  FreeSpaceEvidence judgeSeen(const PreparedScan& seer, const PreparedScan& seen, const Eigen::Isometry3d& T_seer_seen,
                              Marks& confirmed) const;
  FreeSpaceEvidence judgePair(Index a, Index b, const Eigen::Isometry3d& T_a_b, Marks& confirmed_a,
                              Marks& confirmed_b) const;
  bool isNear(const Eigen::Vector3f& point) const { return point.squaredNorm() <= reach_ * reach_; }
  bool isOutOfReach(const Eigen::Isometry3d& T) const { return T.translation().norm() > 2.5 * reach_; }
  const std::vector<PreparedScan>& scans_;
  double unit_ = 1.0;
  double reach_ = 0.0; ///< length
};
} // namespace fresco::registration
