// SPDX-License-Identifier: BSD-3-Clause
#include "scan/floor_plan.h"
#include <algorithm>
#include <cmath>
#include <map>
namespace fresco::registration {
namespace {
// Up, and the two horizontal ones, as rows of a rotation.
std::optional<Eigen::Matrix3f> uprightAxes(const ScanPlanes& planes)
{
  constexpr float upright_cosine = 0.966f; // 15 degrees
  Index up = 0;
  planes.axes.row(2).cwiseAbs().maxCoeff(&up);
  if (std::abs(planes.axes(2, up)) < upright_cosine)
    return std::nullopt;
  Eigen::Matrix3f rows;
  rows.row(2) = std::copysign(1.f, planes.axes(2, up)) * planes.axes.col(up).transpose();
  rows.row(0) = planes.axes.col((up + 1) % 3).transpose();
  rows.row(1) = rows.row(2).cross(rows.row(0));
  return rows;
}

// Height of the plane below the scanner that most points lie on.
std::optional<float> floorHeight(const ScanLevel& level, const Eigen::Vector3f& up, float scanner)
{
  constexpr float facing = 0.95f; // cosine of 18 degrees
  std::map<Index, Index> counts;
  for (Index i = 0; i < level.points.cols(); ++i)
    if (level.normals.col(i).dot(up) > facing && level.points.col(i).dot(up) < scanner)
      ++counts[std::lround(level.points.col(i).dot(up) / level.voxel)];
  if (counts.empty())
    return std::nullopt;
  const auto most =
      std::max_element(counts.begin(), counts.end(), [](const auto& x, const auto& y) { return x.second < y.second; });
  return most->first * level.voxel;
}

class PlanDrawing {
public:
  PlanDrawing(const PreparedScan& scan, const PlanFrame& frame, const PlanGrid& grid)
      : level_(scan.levels[check_level]), frame_(frame), grid_(grid)
  {}

  FloorPlan draw();

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
  void markRay(FloorPlan& plan, const Eigen::Vector3f& from, const Eigen::Vector3f& to) const;
  void clearNear(const FloorPlan::Layer& occupied, FloorPlan::Layer& free) const;

  const ScanLevel& level_;
  const PlanFrame& frame_;
  const PlanGrid& grid_;
};

void PlanDrawing::markRay(FloorPlan& plan, const Eigen::Vector3f& from, const Eigen::Vector3f& to) const
{
  const float length = (to - from).norm(), step = 0.5f * grid_.cell;
  const Eigen::Vector3f direction = (to - from) / length;
  for (float r = step; r < length - grid_.cell; r += step)
    mark(plan.free, from + r * direction);
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

FloorPlan PlanDrawing::draw()
{
  FloorPlan plan;
  for (int layer = 0; layer < plan_layers; ++layer) {
    plan.occupied[layer].assign(static_cast<std::size_t>(grid_.side) * grid_.side, 0);
    plan.free[layer] = plan.occupied[layer];
  }
  for (Index i = 0; i < level_.points.cols(); ++i) {
    const Eigen::Vector3f to = frame_.T_plan_scan * level_.points.col(i);
    mark(plan.occupied, to);
    markRay(plan, frame_.T_plan_scan * level_.viewpoints.col(i), to);
  }
  for (int layer = 0; layer < plan_layers; ++layer)
    clearNear(plan.occupied[layer], plan.free[layer]);
  return plan;
}
} // namespace

std::optional<PlanFrame> findPlanFrame(const PreparedScan& scan, const ScanPlanes& planes)
{
  if (planes.axes.isZero() || scan.free_space.empty())
    return std::nullopt;
  const std::optional<Eigen::Matrix3f> axes = uprightAxes(planes);
  if (!axes)
    return std::nullopt;
  const ScanLevel& level = scan.levels[check_level];
  const Eigen::Vector3f scanner = *axes * level.viewpoints.rowwise().mean();
  const std::optional<float> floor = floorHeight(level, axes->row(2).transpose(), scanner.z());
  if (!floor)
    return std::nullopt;
  PlanFrame frame;
  frame.T_plan_scan.linear() = *axes;
  frame.T_plan_scan.translation() << -scanner.x(), -scanner.y(), -*floor;
  frame.height = scanner.z() - *floor;
  return frame;
}

FloorPlan drawFloorPlan(const PreparedScan& scan, const PlanFrame& frame, const PlanGrid& grid)
{
  return PlanDrawing(scan, frame, grid).draw();
}
} // namespace fresco::registration
