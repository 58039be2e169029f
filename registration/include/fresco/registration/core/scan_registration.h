// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/point_set.h>
#include <fresco/core/progress.h>
#include <fresco/io/pose_file.h>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>
namespace fresco {
class Exchange;

enum class HintKind { link, relative, near, choose, apart, order };

/// What a person knows of the places of scans.
struct RegistrationHint {
  HintKind kind = HintKind::order;                     ///< see docs/hints.md#the-hints-file
  Index a = 0, b = 0;                                  ///< scans; `near` and `order` have no b
  Eigen::Matrix4d T_a_b = Eigen::Matrix4d::Identity(); ///< of `relative`: scan a from scan b, off by up to max_distance
  Eigen::Vector3d place = Eigen::Vector3d::Zero();     ///< of `near`: of the scanner, in the frame of the placed scans
  double radius = 0.0;                                 ///< of `near`, > 0, length
  bool any_height = false;                             ///< of `near`: the height of `place` means nothing
  Index number = 0;                                    ///< of `choose`: CandidatePlace::number
  std::string source;                                  ///< what messages call it: file and line
};

/// Registration of many scans: global alignment of scans without a start pose, then joint point-to-plane refinement.
struct ScanRegistrationOptions {
  float voxel = 0.f;           ///< edge of the finest thinning cells, length; 0 = median range of the scans / 100
  float max_distance = 0.f;    ///< how far start poses may be off, length; 0 = 20 voxels, too far to place what slides
  float min_overlap = 0.1f;    ///< share of a scan's points with a counterpart from which a pair is used, 0..1
  float max_violation = 0.04f; ///< share of a scan's points in space that the other saw through: above, a pair is wrong
  /// Probability below which a place is lost, 0.5..0.9999, but not where a person said so. 0 = those that the joining steps
  /// take stay, whatever their probability.
  double confidence = 0.7;
  int max_iterations = 40; ///< of the joint refinement, per resolution, >= 1
  bool fixed = false;      ///< scans with a start pose keep it exactly; only the others are placed
  bool upright = false;    ///< whether all scanners stood upright to 10 degrees, z upwards: fewer poses are possible
  int threads = 0;         ///< 0 = all cores; the result does not depend on it
  std::vector<std::string> names;      ///< of the scans, for messages; empty = their numbers
  std::vector<RegistrationHint> hints; ///< followed where free space does not contradict them
};

/// What the search of pairs found: to be kept for a second registration of the same scans with other hints.
struct PairMemory {
  std::string bytes; ///< for this program on this kind of machine; empty = nothing
  bool used = false; ///< whether they were of the same scans and options; else they are of this registration now
};

/// Scans that need not be in memory all at once.
struct ScanSource {
  Index count;
  std::function<PointSet(Index)> read; ///< for one scan after the other; called more than once for each
  /// That share out the scans, and the pairs of them, and all come to the result that one would; null = this process
  /// alone. Each reads its own scans only.
  Exchange* ranks = nullptr;
  PairMemory* memory = nullptr; ///< read and filled; null = nothing is kept. Each rank has its own, all the same

  ScanSource(Index scan_count, std::function<PointSet(Index)> reader) : count(scan_count), read(std::move(reader)) {}
};

/// What messages call a scan.
FRESCO_EXPORT std::string scanName(const ScanRegistrationOptions& options, Index scan);

/// A relative pose that explains two scans, but was not taken.
struct AlternativePose {
  Eigen::Matrix4d T_a_b = Eigen::Matrix4d::Identity(); ///< scan a from scan b
  double overlap = 0.0;                                ///< as PairResult::overlap
  double violation = 0.0;                              ///< as PairResult::violation
};

/// One pair of scans at the end.
struct PairResult {
  using Matrix6d = Eigen::Matrix<double, 6, 6>;
  Index a = 0, b = 0;     ///< a < b
  double overlap = 0.0;   ///< larger of the shares of points of one scan with a counterpart in the other, 0..1
  double violation = 0.0; ///< larger of the shares of comparable surfaces in space that the other saw through, 0..1
  double rms = 0.0;       ///< point-to-plane distance of the corresponding points, length
  Index matches = 0;      ///< corresponding points
  bool accepted = false;  ///< holds the two scans together
  /// Scan a from scan b: as placed, if both were placed in one frame, else the best that was found.
  Eigen::Matrix4d T_a_b = Eigen::Matrix4d::Identity();
  /// Inverse covariance of T_a_b from this pair alone: rotation of b about `information_point` (radian), translation of
  /// that point; axes of scan a. Zero without corresponding points.
  Matrix6d information = Matrix6d::Zero();
  /// In the frame of b: the position of its scanner, or the middle of its points.
  Eigen::Vector3d information_point = Eigen::Vector3d::Zero();
  std::vector<AlternativePose> alternatives; ///< others that were found acceptable, best first
};

/// A motion of a scan that its surfaces leave free, such as along a corridor without features.
struct FreeMotion {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero(); ///< direction in the world
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();    ///< axis in the world, through the surfaces that hold the scan
};

/// Which evidence decides that a scan, or its group, is not placed.
enum class RefusalReason {
  none,
  unusable,      ///< ScanResult::problem says why
  nothing_found, ///< no pair with a placed scan has an acceptable relative pose
  too_little,    ///< what agrees at the best place may do so by chance
  contradicted,  ///< free space contradicts the best place
  second_place,  ///< fits the same scans as well at a second place
  repeats,       ///< a scan maps onto itself: an equal room or bay is near
  claimed,       ///< other scans that cannot be there have as good a place for it
  loose,         ///< what holds its place leaves it free
  apart,         ///< a hint
  unsure         ///< less probable than ScanRegistrationOptions::confidence
};

/// What spoke against a place.
struct Refusal {
  RefusalReason reason = RefusalReason::none;
  Index scan = -1;         ///< on the other side: of the group that it was not joined to; -1 = none
  double agree = 0.0;      ///< surfaces that agree there, in scans' worth, see CandidatePlace
  double contradict = 0.0; ///< likewise
};

/// Where a scan or group that is not placed may be, or where a part of a group is.
struct CandidatePlace {
  Index group = 0;            ///< that is not placed, or that holds the part
  Index scan = 0, beside = 0; ///< one of its scans, and one of a larger group, mostly a placed one
  Index number = 0; ///< of the places that the two have, from 1, see HintKind::choose; 0 = found for the whole group
  Eigen::Matrix4d T_beside_scan = Eigen::Matrix4d::Identity();
  Eigen::Matrix4d T_larger_group = Eigen::Matrix4d::Identity(); ///< between the frames of ScanResult::T_group_scan
  double overlap = 0.0;                                         ///< of the two scans there, as PairResult::overlap
  double violation = 0.0;                                       ///< likewise
  /// Points of both groups as deep as the other side measured, over the points of one scan; those of one
  /// count for each scan that sees them. Of equal rooms the wrong one may have more.
  double agree = 0.0;
  double contradict = 0.0;   ///< those in space that the other side saw through, together with their neighbours
  bool contradicted = false; ///< that is more than errors and panes explain
  double probability = 0.0;  ///< that it is right, see docs/hints.md#probability
  std::vector<Index> part;   ///< of ScanRegistrationResult::links: the scans whose place it is
};

/// One scan at the end. Lengths are in the unit of the points.
struct ScanResult {
  bool placed = false;
  std::string problem;           ///< why it was not placed, or what is doubtful about its place
  Refusal refusal;               ///< of a scan without a place
  std::string hint;              ///< that its place rests on; empty = none
  double probability = 0.0;      ///< that its place among the placed scans, or else the likeliest candidate, is right
  std::string viewpoint_problem; ///< why what it saw through is not used; empty = it is
  /// Where it was seen from, in its own frame, to about a decimetre in rooms; only where its file does not tell and its
  /// points do.
  std::optional<Eigen::Vector3d> found_viewpoint;
  Index duplicate_of = -1; ///< the scan that has the same points; -1 = none. Scans with a start pose are none
  Index group = -1;        ///< scans held together by accepted pairs; 0 is the group with poses; -1 = none
  Eigen::Matrix4d T_group_scan = Eigen::Matrix4d::Identity(); ///< within its group, whether placed or not
  double rms = 0.0;                                           ///< point-to-plane distance over its accepted pairs
  /// Standard deviation of the scanner's position: root of the expected squared distance, length. Relative to the scan
  /// that holds the frame, or to the best fit of the group where that is larger. Zero for fixed scans.
  double translation_deviation = 0.0;
  double rotation_deviation = 0.0;               ///< the same of the rotation, radian
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ(); ///< in its own frame: as its surfaces show, else z
  Points outline;                        ///< 3xN, some points of upright surfaces, in its own frame: for pictures
  std::optional<FreeMotion> free_motion; ///< degenerate: the pose is arbitrary along it
};

struct ScanRegistrationResult {
  std::vector<Pose> poses;       ///< world from scan, per scan; nothing where it could not be placed
  std::vector<PairResult> pairs; ///< that overlap or were tried, ordered by (a, b)
  std::vector<ScanResult> scans;
  Index groups = 0;
  std::vector<CandidatePlace> candidates; ///< by group, the best first: not contradicted, then of more overlap
  std::vector<CandidatePlace> links;      ///< what holds groups together, each as the place of the smaller part
  std::vector<std::string> hints;         ///< what became of each hint, a line each
  double rms = 0.0;                       ///< point-to-plane distance over all accepted pairs, length
  float voxel = 0.f;                      ///< that was used
  int iterations = 0;                     ///< of the last refinement, over all resolutions
  bool converged = false;
  bool people_moved = false; ///< between the scans: nothing that may be a person contradicted a pose
};

/// Reads hints, one a line; '#' starts a comment. Words with blanks stand in double quotes.
/// @param names of the scans; a hint may leave out folder and extension where one scan is meant
/// @throws std::runtime_error "PATH: line N: reason"
FRESCO_EXPORT std::vector<RegistrationHint> readHints(const std::string& path, const std::vector<std::string>& names);

/// The line of a hints file that takes a place.
FRESCO_EXPORT std::string hintLine(const CandidatePlace& place, const ScanRegistrationOptions& options);

/// Why a scan is not placed, in words.
FRESCO_EXPORT std::string refusalText(const Refusal& refusal, const ScanRegistrationOptions& options);

/// All of the result as JSON (docs/registration.md#registrationjson), and as a page with floor plans of the groups, readable offline.
FRESCO_EXPORT std::string registrationJson(const ScanRegistrationResult& result,
                                           const ScanRegistrationOptions& options);
FRESCO_EXPORT std::string registrationPage(const ScanRegistrationResult& result,
                                           const ScanRegistrationOptions& options);

/// What a user should know of the result, a line each: scans that could not be read or placed or are doubtful, viewpoints
/// that are not used, people who moved, further groups.
FRESCO_EXPORT std::vector<std::string> registrationWarnings(const ScanRegistrationResult& result,
                                                            const ScanRegistrationOptions& options);

/// The first scan of a group keeps its start pose; with `fixed`, all scans that have one do, and no pair of two such is
/// looked at. Without any, the first scan of the largest group is the world.
/// @param scans one or more; each in its own frame. The viewpoint of a scan without `viewpoints` is its frame's origin.
/// @param start world from scan, one per scan, off by up to max_distance; or empty. Scans without one are aligned
/// globally. A scan whose reading throws std::runtime_error is left out; ScanResult::problem says why.
/// @throws std::invalid_argument if there is no scan, sizes differ, an attribute is malformed, an option is out of
/// range or the scans differ in size so much that their units must differ
FRESCO_EXPORT ScanRegistrationResult registerScans(const std::vector<PointSet>& scans,
                                                   const std::vector<Pose>& start = {},
                                                   const ScanRegistrationOptions& options = {},
                                                   const Progress& progress = {});

/// The same; at any time one scan is in memory, and thinned copies of all.
FRESCO_EXPORT ScanRegistrationResult registerScans(const ScanSource& scans, const std::vector<Pose>& start = {},
                                                   const ScanRegistrationOptions& options = {},
                                                   const Progress& progress = {});

/// All placed scans in the world, one after the other, without non-finite points. Normals (those of the scans turned,
/// else estimated) point to each point's own viewpoint, which is kept per point. Colours, intensities and confidences
/// are kept where all placed scans have them. `origin` differs from zero where the world's coordinates are large.
/// @throws std::invalid_argument if sizes differ or an attribute is malformed
FRESCO_EXPORT PointSet mergeScans(const std::vector<PointSet>& scans, const std::vector<Pose>& poses, int threads = 0);
FRESCO_EXPORT PointSet mergeScans(const ScanSource& scans, const std::vector<Pose>& poses, int threads = 0);

/// The parts of the above one at a time, where all together are more than memory holds. They have one origin; each keeps
/// the attributes that its scan has. Of several ranks each gets its own scans.
/// @param receive gets the scan's number and its points, at least one
FRESCO_EXPORT void forEachPlacedScan(const ScanSource& scans, const std::vector<Pose>& poses,
                                     const std::function<void(Index, PointSet)>& receive, int threads = 0);
} // namespace fresco
