// SPDX-License-Identifier: BSD-3-Clause
#include "scan/scan_free_space.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <fresco/core/constants.h>
#include <fresco/core/statistics.h>
namespace fresco::registration {
namespace {
struct ViewpointGroup {
  Eigen::Vector3f center;
  std::vector<Index> members;
};

std::vector<ViewpointGroup> groupByViewpoint(const Points& points, const Points& viewpoints, float grain)
{
  constexpr std::size_t most_maps = 16; // bounds the memory; further viewpoints join the nearest map
  std::vector<ViewpointGroup> groups;
  for (Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3f viewpoint = viewpoints.col(viewpoints.cols() == 1 ? 0 : i);
    const auto distance = [&](const ViewpointGroup& group) { return (group.center - viewpoint).norm(); };
    auto best = std::min_element(groups.begin(), groups.end(),
                                 [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
    if (best == groups.end() || (distance(*best) > grain && groups.size() < most_maps)) {
      groups.push_back({viewpoint, {}});
      best = groups.end() - 1;
    }
    best->members.push_back(i);
  }
  return groups;
}
} // namespace

ScanFreeSpace::ScanFreeSpace(const Points& points, const Points& viewpoints, float grain) : grain_(grain)
{
  const std::vector<ViewpointGroup> groups = groupByViewpoint(points, viewpoints, grain);
  if (groups.empty())
    return;
  constexpr double points_per_cell = 3.0; // mean over the sphere: with fewer, many cells that were looked at stay empty
  const double count = points.cols(), group_count = groups.size(), cells = count / group_count / points_per_cell;
  side_ = std::clamp(static_cast<int>(std::sqrt(cells / 6.0)), 8, 128);
  // Twice the points' mean distance from their middle: a viewpoint further off makes no range more exact.
  const Eigen::Vector3f middle = points.rowwise().mean();
  const double reach = 2.0 * (points.colwise() - middle).colwise().norm().mean();
  double weight = 0.0;
  for (const ViewpointGroup& group : groups) {
    maps_.push_back(buildMap(points, group.members, group.center, reach));
    weight += group.members.size();
  }
  coherence_ /= weight;
  coverage_ /= group_count;
}

ScanFreeSpace::Map ScanFreeSpace::buildMap(const Points& points, const std::vector<Index>& members,
                                           const Eigen::Vector3f& center, double reach)
{
  constexpr double coherent_share = 0.05; // of the range: a surface seen at a slant varies by so much within a cell
  const Index cells = 6 * side_ * side_;
  Map map{center, std::vector<float>(cells, HUGE_VALF), std::vector<float>(cells, 0.f), std::vector<char>(cells, 0), {},
          0.f};
  std::vector<std::vector<float>> ranges(cells);
  const float spread = float(pi) / 2.f / side_;
  std::array<Eigen::Vector2f, 8> ring;
  for (int step = 0; step < 8; ++step)
    ring[step] = {std::cos(step * float(pi) / 4.f), std::sin(step * float(pi) / 4.f)};
  for (const Index i : members) {
    const Eigen::Vector3f ray = points.col(i) - center;
    const float range = ray.norm();
    if (!(range > 0.f))
      continue;
    const Index own_cell = cubeCell(ray, side_);
    ranges[own_cell].push_back(range);
    map.has_ray[own_cell] = 1;
    // The measurement is spread over its neighbourhood: a cell then bounds what was seen around it too.
    const Eigen::Vector3f direction = ray / range;
    const Eigen::Vector3f u = direction.unitOrthogonal() * spread, v = direction.cross(u);
    for (int step = 0; step < 9; ++step) {
      const Eigen::Vector3f shifted =
          step == 8 ? direction : Eigen::Vector3f(direction + ring[step][0] * u + ring[step][1] * v);
      const Index cell = cubeCell(shifted, side_);
      map.nearest[cell] = std::min(map.nearest[cell], range);
      map.farthest[cell] = std::max(map.farthest[cell], range);
    }
  }
  map.reach = *std::max_element(map.farthest.begin(), map.farthest.end());
  for (std::vector<float>& cell : ranges) {
    if (cell.empty())
      continue;
    coverage_ += 1.0 / cells;
    const double middle = median(cell);
    coherence_ += std::count_if(cell.begin(), cell.end(), [&](float range) {
      return std::abs(range - middle) < grain_ + coherent_share * std::min(middle, reach);
    });
  }
  return map;
}

void ScanFreeSpace::prepareManyJudgements()
{
  for (Map& map : maps_)
    if (map.tiles.empty())
      map.tiles = FarthestTiles(map.farthest, side_);
}

// Whether the rays near that of a point graze its surface, and none of its cell passed through: all may have met the
// surface, or gone by in front of it. A ray half a cell beside that of the point meets the surface so much farther.
bool ScanFreeSpace::isGrazed(const CellRay& ray, const Eigen::Vector3f& normal) const
{
  constexpr float least_cosine = 0.3f;
  const float half_cell = float(pi) / 4.f / side_; // angle
  const float cosine = std::abs(normal.dot(ray.from_center)) / ray.range;
  return !normal.isZero() && cosine < least_cosine && (!ray.is_own || ray.gap * cosine <= half_cell * ray.range);
}

template <typename IsGrazed>
ScanFreeSpace::Verdict ScanFreeSpace::judgePoint(const Eigen::Vector3f& point, const Slack& slack,
                                                 const IsGrazed& isGrazed) const
{
  Verdict verdict = Verdict::unknown;
  for (const Map& map : maps_) {
    const Eigen::Vector3f ray = point - map.center;
    const float range = ray.norm(), margin = slack.absolute + slack.relative * range;
    if (!(range > slack.absolute) || range > map.reach + margin)
      continue;
    const Index cell = cubeCell(ray, side_);
    if (map.nearest[cell] == HUGE_VALF || range > map.farthest[cell] + margin)
      continue;
    // With several viewpoints the point is on a surface if one of them measured it there.
    if (range >= map.nearest[cell] - margin)
      return Verdict::agrees;
    const bool has_ray = map.has_ray[cell] != 0;
    if ((has_ray || !slack.own_rays) && !isGrazed(CellRay{ray, range, map.nearest[cell] - range - margin, has_ray}))
      verdict = Verdict::violates;
  }
  return verdict;
}

// Whether all points of a sphere are unknown: behind all that was seen in their directions.
bool ScanFreeSpace::isOutOfSight(const Eigen::Vector3f& center, float radius, const Slack& slack) const
{
  constexpr float rounding = 1e-4f; // share of a range
  return std::all_of(maps_.begin(), maps_.end(), [&](const Map& map) {
    const Eigen::Vector3f ray = center - map.center;
    const float range = ray.norm(), nearest = (1.f - rounding) * (range - radius);
    const float seen = (1.f - slack.relative) * nearest - slack.absolute; // from there on, all points are farther
    if (seen > map.reach)
      return true;
    return !map.tiles.empty() && radius < std::sin(FarthestTiles::widest) * range && seen > map.tiles.around(ray);
  });
}

std::vector<ScanFreeSpace::Verdict>
ScanFreeSpace::judge(const JudgedPoints& judged, const Eigen::Isometry3f& T_scan_points, const Slack& slack) const
{
  const Points& points = judged.points;
  std::vector<Verdict> verdicts(points.cols(), Verdict::unknown);
  const auto judgeOne = [&](Index i) {
    verdicts[i] = judgePoint(T_scan_points * points.col(i), slack, [&](const CellRay& ray) {
      return judged.normals && isGrazed(ray, T_scan_points.linear() * judged.normals->col(i));
    });
  };
  if (judged.blocks && !judged.blocks->empty())
    judged.blocks->visit([&](const Eigen::Vector3f& center,
                             float radius) { return isOutOfSight(T_scan_points * center, radius, slack); },
                         judgeOne);
  else
    for (Index i = 0; i < points.cols(); ++i)
      judgeOne(i);
  return verdicts;
}
} // namespace fresco::registration
