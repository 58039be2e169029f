// SPDX-License-Identifier: BSD-3-Clause
#include "scan/scan_free_space.h"
#include <algorithm>
#include <cmath>
#include <limits>
namespace fresco::registration {
namespace {
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr std::size_t most_maps = 16;   // further viewpoints join the nearest map
constexpr double points_per_cell = 3.0; // mean over the sphere: sparse scans get wide cells
constexpr double coherent_share = 0.05; // of the range: within it and `grain`, ranges of one direction are one surface

// Cell of a direction on a cube map with 6 * side * side cells.
std::size_t cellOf(const Eigen::Vector3f& direction, int side)
{
  Index axis = 0;
  const float length = direction.cwiseAbs().maxCoeff(&axis);
  const int face = static_cast<int>(axis) * 2 + (direction[axis] < 0.f ? 1 : 0);
  const auto slot = [&](Index other) {
    // atan makes the cells about equally wide in angle.
    const float across = std::atan(direction[other % 3] / length) * (4.f / static_cast<float>(M_PI));
    return std::clamp(static_cast<int>((across + 1.f) * 0.5f * static_cast<float>(side)), 0, side - 1);
  };
  return (static_cast<std::size_t>(face) * static_cast<std::size_t>(side) + static_cast<std::size_t>(slot(axis + 1))) *
             static_cast<std::size_t>(side) +
         static_cast<std::size_t>(slot(axis + 2));
}

struct ViewpointGroup {
  Eigen::Vector3f center;
  std::vector<Index> members;
};

std::vector<ViewpointGroup> groupByViewpoint(const Points& points, const Points& viewpoints, float grain)
{
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

double median(std::vector<float>& values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}
} // namespace

FreeSpace::FreeSpace(const Points& points, const Points& viewpoints, float grain) : grain_(grain)
{
  const std::vector<ViewpointGroup> groups = groupByViewpoint(points, viewpoints, grain);
  if (groups.empty())
    return;
  const double cells = static_cast<double>(points.cols()) / static_cast<double>(groups.size()) / points_per_cell;
  side_ = std::clamp(static_cast<int>(std::sqrt(cells / 6.0)), 8, 128);
  double weight = 0.0;
  for (const ViewpointGroup& group : groups) {
    maps_.push_back(buildMap(points, group.members, group.center));
    weight += static_cast<double>(group.members.size());
  }
  coherence_ /= weight;
  coverage_ /= static_cast<double>(groups.size());
}

FreeSpace::Map FreeSpace::buildMap(const Points& points, const std::vector<Index>& members,
                                   const Eigen::Vector3f& center)
{
  const std::size_t cells = 6 * static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_);
  Map map{center, std::vector<float>(cells, infinity), std::vector<float>(cells, 0.f)};
  std::vector<std::vector<float>> ranges(cells);
  const float spread = static_cast<float>(M_PI) / 2.f / static_cast<float>(side_);
  for (const Index i : members) {
    const Eigen::Vector3f ray = points.col(i) - center;
    const float range = ray.norm();
    if (!(range > 0.f))
      continue;
    ranges[cellOf(ray, side_)].push_back(range);
    // The measurement is spread over its neighbourhood: a cell then bounds what was seen around it too.
    const Eigen::Vector3f direction = ray / range;
    const Eigen::Vector3f u = direction.unitOrthogonal() * spread, v = direction.cross(u);
    for (int step = 0; step < 9; ++step) {
      const float angle = static_cast<float>(step) * static_cast<float>(M_PI) / 4.f;
      const Eigen::Vector3f shifted =
          step == 8 ? direction : Eigen::Vector3f(direction + std::cos(angle) * u + std::sin(angle) * v);
      const std::size_t cell = cellOf(shifted, side_);
      map.nearest[cell] = std::min(map.nearest[cell], range);
      map.farthest[cell] = std::max(map.farthest[cell], range);
    }
  }
  for (std::vector<float>& cell : ranges) {
    if (cell.empty())
      continue;
    coverage_ += 1.0 / static_cast<double>(cells);
    const double middle = median(cell);
    coherence_ += static_cast<double>(std::count_if(cell.begin(), cell.end(), [&](float range) {
      return std::abs(range - middle) < grain_ + coherent_share * middle;
    }));
  }
  return map;
}

std::vector<FreeSpace::Verdict> FreeSpace::judge(const Points& points, const Eigen::Isometry3f& T_scan_points,
                                                 const Slack& slack) const
{
  std::vector<Verdict> verdicts(points.cols(), Verdict::unknown);
  for (Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3f point = T_scan_points * points.col(i);
    Verdict& verdict = verdicts[i];
    for (const Map& map : maps_) {
      const Eigen::Vector3f ray = point - map.center;
      const float range = ray.norm(), margin = slack.absolute + slack.relative * range;
      if (!(range > slack.absolute))
        continue;
      const std::size_t cell = cellOf(ray, side_);
      if (map.nearest[cell] == infinity || range > map.farthest[cell] + margin)
        continue;
      // With several viewpoints the point is on a surface if one of them measured it there.
      if (range >= map.nearest[cell] - margin) {
        verdict = Verdict::agrees;
        break;
      }
      verdict = Verdict::violates;
    }
  }
  return verdicts;
}
} // namespace fresco::registration
