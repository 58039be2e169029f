// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan/prepared_scan.h"
#include <Eigen/Geometry>
#include <optional>
namespace fresco::registration {
/// When a point has a counterpart in another scan.
struct OverlapTest {
  float distance = 0.f;   ///< of the counterpart, below, length
  float max_angle = 0.8f; ///< between the normals, below, radians
  Index most = 2000;      ///< samples that are tested: the share is then known to about 1 %
  bool oriented = true;   ///< whether the signs of both normals mean something
};

/// Share of the first samples of `source` that have a counterpart in `target`, 0..1.
double overlapShare(const ScanLevel& source, const ScanLevel& target, const Eigen::Isometry3f& T_target_source,
                    const OverlapTest& test);

/// So many samples of a level look for a counterpart.
struct SampledLevel {
  int level;
  Index most;
};

/// Larger of the shares of the samples of either scan that have a counterpart in the other, 0..1.
double pairOverlap(const PreparedScan& a, const PreparedScan& b, const Eigen::Isometry3d& T_a_b,
                   const SampledLevel& samples);

/// Whether surfaces that the seer's rays grazed violate, see ScanFreeSpace::judge(). They are spared at places that many
/// pairs of scans judge together, whose errors add up. Between hypotheses of one pair the little that is grazed may
/// decide.
enum class Grazed { counts, spared };

/// What a scan says of all points of a level. If it spares what is doubtful, people do not violate, nor what lies in
/// directions without a ray of their own; of what is grazed, little is left then that is misread, and all counts.
std::vector<ScanFreeSpace::Verdict> judgeLevel(const PreparedScan& seer, const ScanLevel& level,
                                               const Eigen::Isometry3f& T_seer_level, Grazed grazed);

/// Whether most neighbours of a point that violates do so, too: mixed pixels at edges violate alone, misplaced surfaces
/// all over.
/// @param verdicts on all points of the level
bool violatesWithNeighbours(const ScanLevel& level, const std::vector<ScanFreeSpace::Verdict>& verdicts, Index point);

/// What a pair of scans says about their relative pose.
struct PairCheck {
  double overlap = 0.0; ///< larger of the two shares of points with a counterpart, 0..1
  /// Larger share of comparable points that lie, together with their neighbours, in space that the other scan saw
  /// through, 0..1; of half of all points where fewer are comparable to a scan that saw around.
  double violation = 0.0;
  double violation_a = 0.0, violation_b = 0.0; ///< a's and b's free space of the other: shares of comparable points
  Index violating_points = 0; ///< points of both in space that the other saw through, also without their neighbours
  /// Pearson's correlation of the colours of corresponding points, -1..1; absent without enough of them.
  std::optional<double> color;
};

constexpr double noise_violation = 0.002; ///< of a pair: mixed pixels do not cause more
constexpr double pane_violation = 0.01;   ///< of a pair: some may have seen a pane
constexpr double strong_overlap = 0.25;   ///< of a pair: hardly by chance
constexpr double good_color = 0.6;        ///< correlation: below, colours of one place differ by more than light

/// @param level index into PreparedScan::levels: the finer, the smaller the errors of the pose and the misplaced
/// surfaces that count as violations
PairCheck checkPair(const PreparedScan& a, const PreparedScan& b, const Eigen::Isometry3d& T_a_b, int level);

/// The same from fewer samples and without colours: to sort out hypotheses.
PairCheck checkRoughly(const PreparedScan& a, const PreparedScan& b, const Eigen::Isometry3d& T_a_b, int level,
                       Grazed grazed = Grazed::counts);

/// The larger share of few points of check_level in space that the other scan saw through. Points that lie there alone
/// count, so mixed pixels do.
double sampledViolation(const PreparedScan& a, const PreparedScan& b, const Eigen::Isometry3d& T_a_b);

/// PairCheck::violation alone, without what is grazed.
double pairViolation(const PreparedScan& a, const PreparedScan& b, const Eigen::Isometry3d& T_a_b, int level);
} // namespace fresco::registration
