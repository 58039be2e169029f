// SPDX-License-Identifier: BSD-3-Clause
#include "overlap/pair_overlap.h"
#include <algorithm>
#include <cmath>
namespace fresco::registration {
double overlapShare(const ScanLevel& source, const ScanLevel& target, const Eigen::Isometry3f& T_target_source,
                    const OverlapTest& test)
{
  const Index count = std::min(test.most, static_cast<Index>(source.samples.size()));
  const float least_cosine = std::cos(test.max_angle);
  Index found = 0;
  for (Index k = 0; k < count; ++k) {
    const Index i = source.samples[k];
    const auto hit = target.nearest(T_target_source * source.points.col(i), test.distance);
    if (hit.index < 0)
      continue;
    const float cosine = target.normals.col(hit.index).dot(T_target_source.linear() * source.normals.col(i));
    found += (test.oriented ? cosine : std::abs(cosine)) > least_cosine ? 1 : 0;
  }
  return count > 0 ? 1.0 * found / count : 0.0;
}

double pairOverlap(const PreparedScan& a, const PreparedScan& b, const Eigen::Isometry3d& T_a_b,
                   const SampledLevel& samples)
{
  const ScanLevel &level_a = a.levels[samples.level], &level_b = b.levels[samples.level];
  level_a.prepareSearch();
  level_b.prepareSearch();
  OverlapTest test;
  test.distance = 2.f * std::max(level_a.voxel, level_b.voxel);
  test.most = samples.most;
  test.oriented = a.oriented && b.oriented;
  return std::max(overlapShare(level_b, level_a, T_a_b.cast<float>(), test),
                  overlapShare(level_a, level_b, T_a_b.inverse().cast<float>(), test));
}

namespace {
using Verdict = ScanFreeSpace::Verdict;

// How far in front of measured ranges points of a level still agree with them.
ScanFreeSpace::Slack slackOf(const ScanLevel& level) { return {1.5f * level.voxel, 0.02f}; }
} // namespace

std::vector<Verdict> judgeLevel(const PreparedScan& seer, const ScanLevel& level, const Eigen::Isometry3f& T_seer_level,
                                Grazed grazed)
{
  ScanFreeSpace::Slack slack = slackOf(level);
  slack.own_rays = seer.spares_doubtful;
  const bool spare_grazed = grazed == Grazed::spared && !seer.spares_doubtful;
  std::vector<Verdict> verdicts = seer.free_space.judge(
      {level.points, spare_grazed ? &level.normals : nullptr, &level.blocks}, T_seer_level, slack);
  for (std::size_t i = 0; seer.spares_doubtful && i < level.maybe_person.size(); ++i)
    if (level.maybe_person[i] != 0 && verdicts[i] == Verdict::violates)
      verdicts[i] = Verdict::unknown;
  return verdicts;
}

bool violatesWithNeighbours(const ScanLevel& level, const std::vector<ScanFreeSpace::Verdict>& verdicts, Index point)
{
  constexpr int fewest_violating = 6; // of the point and its 7 neighbours
  int around = 0;
  for (const std::int32_t hit : level.around.col(point))
    around += hit >= 0 && verdicts[hit] == ScanFreeSpace::Verdict::violates ? 1 : 0;
  return around >= fewest_violating;
}

namespace {
struct Violation {
  double of_comparable = 0.0, share = 0.0; // share: of at least half of all points
  Index points = 0;
};

// Points of a level that lie, together with their neighbours, in space that was seen through; how many lie there with or
// without them.
Violation findViolation(const PreparedScan& seer, const ScanLevel& level, const Eigen::Isometry3f& T_seer_level,
                        Grazed grazed)
{
  if (seer.free_space.empty())
    return {};
  const std::vector<Verdict> verdicts = judgeLevel(seer, level, T_seer_level, grazed);
  Index comparable = 0, violating = 0, points = 0;
  for (Index i = 0; i < level.points.cols(); ++i) {
    comparable += verdicts[i] != Verdict::unknown ? 1 : 0;
    if (verdicts[i] != Verdict::violates)
      continue;
    ++points;
    violating += violatesWithNeighbours(level, verdicts, i) ? 1 : 0;
  }
  // Half of all points: of few, a handful that are misread is a large share. Who looks one way compares few anyway.
  const double least_comparable = sawAround(seer) ? 0.5 * level.points.cols() : 1.0;
  return {1.0 * violating / std::max<Index>(1, comparable), violating / std::max(least_comparable, 1.0 * comparable),
          points};
}

// Pearson's correlation, pooled over the three channels: blind to gain and offset of each scan.
std::optional<double> colorCorrelation(const ScanLevel& source, const ScanLevel& target,
                                       const Eigen::Isometry3f& T_target_source, float distance)
{
  constexpr Index most_samples = 3000, fewest_samples = 300; // the correlation is then known to 0.02 and 0.06
  constexpr double least_variance = 3 * 6.0 * 6.0; // of 8-bit colours, sum of the channels: below, noise decides
  if (source.colors.cols() == 0 || target.colors.cols() == 0)
    return {};
  Eigen::Array3d sx(0, 0, 0), sy(0, 0, 0), sxx(0, 0, 0), syy(0, 0, 0), sxy(0, 0, 0);
  Index count = 0;
  for (Index k = 0; k < std::min(most_samples, static_cast<Index>(source.samples.size())); ++k) {
    const Index i = source.samples[k];
    const auto hit = target.nearest(T_target_source * source.points.col(i), distance);
    if (hit.index < 0)
      continue;
    const Eigen::Array3d x = source.colors.col(i).cast<double>(), y = target.colors.col(hit.index).cast<double>();
    sx += x;
    sy += y;
    sxx += x * x;
    syy += y * y;
    sxy += x * y;
    ++count;
  }
  const double n = count;
  const double vx = (sxx - sx * sx / n).sum() / n, vy = (syy - sy * sy / n).sum() / n;
  if (count < fewest_samples || vx < least_variance || vy < least_variance)
    return {};
  return (sxy - sx * sy / n).sum() / n / std::sqrt(vx * vy);
}

// Of the sampled points of a level.
double sampledShare(const ScanFreeSpace& space, const ScanLevel& level, const Eigen::Isometry3f& T_space_level)
{
  constexpr std::size_t few = 150; // the share is known to 4 %
  if (space.empty())
    return 0.0;
  std::vector<Index> some(level.samples.begin(), level.samples.begin() + std::min(few, level.samples.size()));
  const Points points = level.points(Eigen::all, some);
  Index comparable = 0, violating = 0;
  for (const auto verdict : space.judge({points}, T_space_level, slackOf(level))) {
    comparable += verdict != ScanFreeSpace::Verdict::unknown ? 1 : 0;
    violating += verdict == ScanFreeSpace::Verdict::violates ? 1 : 0;
  }
  return 1.0 * violating / std::max<Index>(1, comparable);
}
} // namespace

double sampledViolation(const PreparedScan& a, const PreparedScan& b, const Eigen::Isometry3d& T_a_b)
{
  return std::max(sampledShare(a.free_space, b.levels[check_level], T_a_b.cast<float>()),
                  sampledShare(b.free_space, a.levels[check_level], T_a_b.inverse().cast<float>()));
}

double pairViolation(const PreparedScan& a, const PreparedScan& b, const Eigen::Isometry3d& T_a_b, int level)
{
  return std::max(findViolation(a, b.levels[level], T_a_b.cast<float>(), Grazed::spared).share,
                  findViolation(b, a.levels[level], T_a_b.inverse().cast<float>(), Grazed::spared).share);
}

namespace {
struct CheckDetail : SampledLevel {
  Grazed grazed;
};

// All but the colours.
PairCheck checkSurfaces(const PreparedScan& a, const PreparedScan& b, const Eigen::Isometry3d& T_a_b,
                        const CheckDetail& detail)
{
  PairCheck check;
  check.overlap = pairOverlap(a, b, T_a_b, detail);
  const Violation by_a = findViolation(a, b.levels[detail.level], T_a_b.cast<float>(), detail.grazed),
                  by_b = findViolation(b, a.levels[detail.level], T_a_b.inverse().cast<float>(), detail.grazed);
  check.violation_a = by_a.of_comparable;
  check.violation_b = by_b.of_comparable;
  check.violating_points = by_a.points + by_b.points;
  check.violation = std::max(by_a.share, by_b.share);
  return check;
}
} // namespace

PairCheck checkPair(const PreparedScan& a, const PreparedScan& b, const Eigen::Isometry3d& T_a_b, int level)
{
  PairCheck check = checkSurfaces(a, b, T_a_b, {{level, OverlapTest().most}, Grazed::counts});
  const ScanLevel &level_a = a.levels[level], &level_b = b.levels[level];
  check.color = colorCorrelation(level_b, level_a, T_a_b.cast<float>(), std::max(level_a.voxel, level_b.voxel));
  return check;
}

PairCheck checkRoughly(const PreparedScan& a, const PreparedScan& b, const Eigen::Isometry3d& T_a_b, int level,
                       Grazed grazed)
{
  constexpr Index few = 500; // samples: the share is known to 2 %
  return checkSurfaces(a, b, T_a_b, {{level, few}, grazed});
}
} // namespace fresco::registration
