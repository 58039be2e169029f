// SPDX-License-Identifier: BSD-3-Clause
#include "scan/floor_plan.h"
#include "scan/lists.h"
#include "scan/up_direction.h"
#include <algorithm>
#include <cmath>
#include <numeric>
namespace fresco::registration {
namespace {
// Of the axes, if there are any, the one that was vertical while the scanner stood upright.
std::optional<Eigen::Vector3f> uprightAxis(const ScanPlanes& planes)
{
  constexpr float upright_cosine = 0.966f; // 15 degrees
  Index up = 0;
  planes.axes.row(2).cwiseAbs().maxCoeff(&up);
  if (std::abs(planes.axes(2, up)) < upright_cosine)
    return std::nullopt;
  return std::copysign(1.f, planes.axes(2, up)) * planes.axes.col(up);
}

// Two horizontal axes and up, as rows of a rotation.
Eigen::Matrix3f planAxes(const ScanPlanes& planes, const Eigen::Vector3f& up)
{
  Index vertical = 0;
  (planes.axes.transpose() * up).cwiseAbs().maxCoeff(&vertical);
  Eigen::Matrix3f rows;
  rows.row(2) = up.transpose();
  rows.row(0) = planes.axes.col((vertical + 1) % 3).transpose();
  rows.row(1) = rows.row(2).cross(rows.row(0));
  return rows;
}

// Height of the plane below the scanner that most points lie on: the mean of those within a voxel of it, since plans of
// scans are compared by layers of height.
std::optional<float> floorHeight(const ScanLevel& level, const Eigen::Vector3f& up, float scanner)
{
  std::vector<float> heights;
  for (Index i = 0; i < level.points.cols(); ++i)
    if (level.normals.col(i).dot(up) > facing && level.points.col(i).dot(up) < scanner)
      heights.push_back(level.points.col(i).dot(up));
  const std::optional<float> middle = fullestBin(heights, level.voxel);
  if (!middle)
    return std::nullopt;
  const auto floor = std::partition(heights.begin(), heights.end(),
                                    [&](float height) { return std::abs(height - *middle) < level.voxel; });
  return std::accumulate(heights.begin(), floor, 0.f) / static_cast<float>(floor - heights.begin());
}

class PlanDrawing {
public:
  explicit PlanDrawing(const PlanGrid& grid);

  void add(const PlanScan& placed);
  FloorPlan finish();

private:
  // Layer of a height over the floor, -1 = none.
  int layerOf(float z) const
  {
    constexpr float lowest = 0.15f, step = 0.45f; // of the scanner's height: the floor itself tells nothing
    const float layer = (z / grid_.height - lowest) / step;
    return layer < 0.f || layer >= plan_layers ? -1 : static_cast<int>(layer);
  }
  bool within(float x) const { return std::abs(x) < 0.48f * grid_.side; }
  Index cellOf(float x, float y) const
  {
    const int mask = grid_.side - 1;
    return (static_cast<int>(std::lround(y)) & mask) * grid_.side + (static_cast<int>(std::lround(x)) & mask);
  }
  void mark(std::array<FloorPlan::Layer, plan_layers>& layers, const Eigen::Vector3f& p) const
  {
    const int layer = layerOf(p.z());
    const float x = p.x() / grid_.cell, y = p.y() / grid_.cell;
    if (layer >= 0 && within(x) && within(y))
      layers[layer][cellOf(x, y)] = 1;
  }
  void markRay(const Eigen::Vector3f& from, const Eigen::Vector3f& to, const Eigen::Vector3f& normal);
  void keepInner(FloorPlan::Layer& free) const;
  void clearNear(const FloorPlan::Layer& occupied, FloorPlan::Layer& free) const;

  const PlanGrid& grid_;
  FloorPlan plan_;
};

PlanDrawing::PlanDrawing(const PlanGrid& grid) : grid_(grid)
{
  for (int layer = 0; layer < plan_layers; ++layer) {
    plan_.occupied[layer].assign(static_cast<std::size_t>(grid_.side) * grid_.side, 0);
    plan_.free[layer] = plan_.occupied[layer];
  }
}

// Up to a cell in front of the surface where it ends: a ray passes through the cells of a wall that it grazes.
void PlanDrawing::markRay(const Eigen::Vector3f& from, const Eigen::Vector3f& to, const Eigen::Vector3f& normal)
{
  const float length = (to - from).norm(), step = 0.5f * grid_.cell;
  const Eigen::Vector3f direction = (to - from) / length;
  const float cosine = std::abs(direction.dot(normal));
  for (float r = step; (length - r) * cosine > grid_.cell; r += step)
    mark(plan_.free, from + r * direction);
}

void PlanDrawing::keepInner(FloorPlan::Layer& free) const
{
  const int n = grid_.side, mask = n - 1;
  const FloorPlan::Layer seen = free;
  const auto is_seen = [&](int x, int y) { return seen[(y & mask) * n + (x & mask)] != 0; };
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x)
      free[y * n + x] =
          is_seen(x, y) && is_seen(x - 1, y) && is_seen(x + 1, y) && is_seen(x, y - 1) && is_seen(x, y + 1);
}

void PlanDrawing::clearNear(const FloorPlan::Layer& occupied, FloorPlan::Layer& free) const
{
  const int n = grid_.side, mask = n - 1;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x)
      if (occupied[y * n + x] != 0)
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx)
            free[((y + dy) & mask) * n + ((x + dx) & mask)] = 0;
}

void PlanDrawing::add(const PlanScan& placed)
{
  constexpr float level_cosine = 0.9f; // 26 degrees
  const ScanLevel& level = placed.scan.levels[check_level];
  for (Index i = 0; i < level.points.cols(); ++i) {
    const Eigen::Vector3f from = placed.T_plan_scan * level.viewpoints.col(i);
    const Eigen::Vector3f to = placed.T_plan_scan * level.points.col(i);
    const Eigen::Vector3f normal = placed.T_plan_scan.linear() * level.normals.col(i);
    const bool is_ceiling = to.z() > from.z() && std::abs(normal.z()) > level_cosine;
    if (!is_ceiling)
      mark(plan_.occupied, to);
    markRay(from, to, normal);
  }
}

FloorPlan PlanDrawing::finish()
{
  for (int layer = 0; layer < plan_layers; ++layer) {
    if (grid_.inner_free)
      keepInner(plan_.free[layer]);
    clearNear(plan_.occupied[layer], plan_.free[layer]);
  }
  return std::move(plan_);
}
} // namespace

std::optional<PlanFrame> findPlanFrame(const PreparedScan& scan, const ScanPlanes& planes)
{
  const std::optional<Eigen::Vector3f> up = uprightAxis(planes);
  return up ? findPlanFrame(scan, planes, *up) : std::nullopt;
}

std::optional<PlanFrame> findPlanFrame(const PreparedScan& scan, const ScanPlanes& planes, const Eigen::Vector3f& up)
{
  if (scan.free_space.empty())
    return std::nullopt;
  const Eigen::Matrix3f axes = planAxes(planes, up);
  const ScanLevel& level = scan.levels[check_level];
  const Eigen::Vector3f scanner = axes * level.viewpoints.rowwise().mean();
  const std::optional<float> floor = floorHeight(level, up, scanner.z());
  if (!floor)
    return std::nullopt;
  PlanFrame frame;
  frame.T_plan_scan.linear() = axes;
  frame.T_plan_scan.translation() << -scanner.x(), -scanner.y(), -*floor;
  frame.height = scanner.z() - *floor;
  return frame;
}

PlanFrames findPlanFrames(const std::vector<PreparedScan>& scans, int threads)
{
  std::vector<ScanPlanes> planes(scans.size());
  PlanFrames frames(scans.size());
  forEachTask(scans.size(), threads, [&](Index k) {
    if (!scans[k].problem.empty())
      return;
    planes[k] = findPlanes(scans[k]);
    frames[k] = findPlanFrame(scans[k], planes[k]);
  });
  const Index upright =
      std::count_if(frames.begin(), frames.end(), [](const auto& frame) { return frame.has_value(); });
  if (upright == countUsable(scans))
    return frames;
  const UpDirections ups = findUpDirections(scans, planes);
  for (std::size_t k = 0; k < scans.size(); ++k)
    frames[k] = ups[k] ? findPlanFrame(scans[k], planes[k], *ups[k]) : std::nullopt;
  return frames;
}

FloorPlan drawFloorPlan(const std::vector<PlanScan>& scans, const PlanGrid& grid)
{
  PlanDrawing drawing(grid);
  for (const PlanScan& placed : scans)
    drawing.add(placed);
  return drawing.finish();
}
} // namespace fresco::registration
