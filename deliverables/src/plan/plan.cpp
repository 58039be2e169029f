// SPDX-License-Identifier: BSD-3-Clause
#include "plan/openings.h"
#include "plan/outline.h"
#include "plan/regions.h"
#include "plan/surfaces.h"
#include <Eigen/Geometry>
#include <fresco/core/require.h>
#include <unordered_set>
namespace fresco {
namespace plan {
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {
/// What a plan is drawn from, whatever it comes from; frame of the plan, without the origin of the input.
struct Building {
  LevelSamples level;
  Storey storey;
  std::vector<Vector3f> upright;
};

void validate(const PlanOptions& o)
{
  require(o.tolerance > 0 && o.tolerance <= 0.1, "plan: tolerance ", o.tolerance, " m is not above 0 and up to 0.1");
  require(o.cell == 0 || (o.cell >= 0.005 && o.cell <= 0.2), "plan: cell ", o.cell, " m is not in 0.005..0.2");
  require(o.door >= 0.3 && o.door <= 5, "plan: door ", o.door, " m is not in 0.3..5");
  require(o.up.allFinite() && o.up.norm() > 0, "plan: the upright direction is zero or not finite");
  require(!std::isinf(o.height), "plan: the height is not finite");
}

double shoelace(const Polyline& line)
{
  double twice = 0;
  for (Index k = 0; k + 1 < line.cols(); ++k)
    twice += line(0, k) * line(1, k + 1) - line(0, k + 1) * line(1, k);
  return twice / 2;
}

Polyline closedLine(const std::vector<PlanWall>& walls)
{
  Polyline line(2, walls.size() + 1);
  for (std::size_t k = 0; k <= walls.size(); ++k)
    line.col(k) = walls[k % walls.size()].from;
  return line;
}

/// Floor and ceiling of each room, from the level samples over it.
void measureHeights(const Building& building, const Regions& regions, std::vector<PlanRoom>& rooms)
{
  std::vector<std::vector<float>> low(rooms.size()), high(rooms.size());
  for (std::size_t i = 0; i < building.level.points.size(); ++i) {
    const Vector3f& p = building.level.points[i];
    const Index at = regions.grid.at(p.x(), p.y());
    const int room = at < 0 ? -1 : regions.labels[at];
    if (room < 0)
      continue;
    if (p.z() < building.storey.height && p.z() > building.storey.floor - 0.5 && building.level.facing[i] >= 0)
      low[room].push_back(p.z());
    if (p.z() > building.storey.height && p.z() < building.storey.ceiling + 0.5 && building.level.facing[i] <= 0)
      high[room].push_back(p.z());
  }
  for (std::size_t r = 0; r < rooms.size(); ++r) {
    const double floor = mainHeight(low[r]), ceiling = building.storey.has_ceiling ? mainHeight(high[r]) : NAN;
    rooms[r].floor = std::isnan(floor) ? building.storey.floor : floor;
    rooms[r].ceiling = std::isnan(ceiling) ? rooms[r].floor : ceiling;
  }
}

std::vector<Vector3f> wallSamples(const Building& building)
{
  std::vector<Vector3f> walls;
  for (const Vector3f& p : building.upright)
    if (p.z() >= building.storey.wall_low && p.z() <= building.storey.wall_high)
      walls.push_back(p);
  return walls;
}

/// Outlines with straight walls.
void drawOutlines(const Building& building, const Regions& regions, FloorPlan& plan)
{
  const PlanePoints samples(wallSamples(building));
  const OutlineOptions options{plan.cell, plan.tolerance};
  std::vector<std::vector<std::vector<OutlineEdge>>> rings(regions.regions.size());
  std::vector<OutlineEdge> all;
  for (std::size_t r = 0; r < rings.size(); ++r) {
    rings[r].push_back(fitEdges(regions.regions[r].outline, samples, options));
    for (const Polyline& column : regions.regions[r].columns)
      rings[r].push_back(fitEdges(column, samples, options));
    for (const auto& ring : rings[r])
      all.insert(all.end(), ring.begin(), ring.end());
  }
  plan.directions = mainDirections(all, plan.tolerance);
  for (std::size_t r = 0; r < rings.size(); ++r) {
    PlanRoom room;
    room.label = regions.regions[r].label;
    for (std::size_t k = 0; k < rings[r].size(); ++k) {
      if (rings[r][k].size() < 3)
        continue;
      const std::vector<PlanWall> walls = joinEdges(rings[r][k], plan.directions, samples, options);
      const Polyline line = closedLine(walls);
      room.area += shoelace(line); // of columns negative
      (k == 0 ? room.outline : room.columns.emplace_back()) = line;
      room.walls.insert(room.walls.end(), walls.begin(), walls.end());
    }
    plan.rooms.push_back(room);
  }
}

/// One point per cell.
Eigen::Matrix2Xd pointsAtCut(const Building& building, const Grid& grid)
{
  constexpr double half = 0.03; // metres
  std::unordered_set<Index> taken;
  std::vector<Vector2d> kept;
  for (const Vector3f& p : building.upright)
    if (std::abs(p.z() - building.storey.height) <= half && taken.insert(grid.at(p.x(), p.y())).second)
      kept.push_back(p.head<2>().cast<double>());
  Eigen::Matrix2Xd points(2, kept.size());
  for (std::size_t k = 0; k < kept.size(); ++k)
    points.col(k) = kept[k];
  return points;
}

FloorPlan planOf(const Building& building, const PlanOptions& options, bool cloud)
{
  FloorPlan plan;
  const Regions regions = findRegions({building.level, building.upright, building.storey, options.cell, options.door});
  plan.height = building.storey.height;
  plan.floor = building.storey.floor;
  plan.ceiling = building.storey.ceiling;
  plan.has_ceiling = building.storey.has_ceiling;
  plan.tolerance = options.tolerance;
  plan.cell = regions.grid.cell;
  drawOutlines(building, regions, plan);
  measureHeights(building, regions, plan.rooms);
  const PlanePoints upright(building.upright);
  for (PlanRoom& room : plan.rooms)
    for (PlanWall& wall : room.walls)
      if (wall.seen)
        wall.openings = findOpenings(wall, room.floor, {upright, building.storey, regions, plan.cell});
  if (cloud)
    plan.points = pointsAtCut(building, regions.grid);
  return plan;
}

/// Moves a plan to where the model stands, and measures how large it is.
void place(FloorPlan& plan, const Vector3d& origin)
{
  const Vector2d shift = origin.head<2>();
  plan.height += origin.z(), plan.floor += origin.z(), plan.ceiling += origin.z();
  const auto move = [&](auto& line) {
    line.colwise() += shift;
    plan.low = plan.low.cwiseMin(line.rowwise().minCoeff());
    plan.high = plan.high.cwiseMax(line.rowwise().maxCoeff());
  };
  plan.low.setConstant(std::numeric_limits<double>::infinity());
  plan.high = -plan.low;
  for (Polyline& line : plan.section)
    move(line);
  if (plan.points.cols() > 0)
    move(plan.points);
  for (PlanRoom& room : plan.rooms) {
    move(room.outline);
    for (Polyline& column : room.columns)
      move(column);
    room.label += shift;
    room.floor += origin.z(), room.ceiling += origin.z();
    for (PlanWall& wall : room.walls) {
      wall.from += shift, wall.to += shift;
      for (PlanOpening& opening : wall.openings)
        opening.from += shift, opening.to += shift;
    }
  }
  if (plan.empty())
    plan.low = plan.high = shift;
}

/// `up` is turned to z, then the floor is made level about `middle`; without the origin of the model.
struct PlanFrame {
  Eigen::Matrix3d R;
  Vector3d shift = Vector3d::Zero();
  Points apply(const Points& p) const { return ((R * p.cast<double>()).colwise() + shift).cast<float>(); }
};

/// @param levelOf samples of points in the frame of the plan
template <typename LevelOf>
PlanFrame findFrame(const Points& points, const PlanOptions& options, const LevelOf& levelOf)
{
  PlanFrame frame{turnToZ(options.up)};
  const Points turned = frame.apply(points);
  const Eigen::Matrix3d levelling = levellingTurn(levelOf(turned));
  const Vector3d middle = (turned.rowwise().minCoeff() + turned.rowwise().maxCoeff()).cast<double>() / 2;
  frame.R = levelling * frame.R;
  frame.shift = middle - levelling * middle; // the middle stays, so that far origins do not magnify the turn
  return frame;
}

/// Height of the cut without the origin; the range of a refusal is that of the model.
Storey storeyOf(const LevelSamples& level, const PlanOptions& options, double origin)
{
  const auto rounded = [&](double z) { return std::round(1000 * (z + origin)) / 1000 + 0.0; }; // no -0
  const double low = rounded(level.lowest), high = rounded(level.highest);
  require(std::isnan(options.height) || (options.height >= low && options.height <= high), "plan: height ",
          options.height, " m is outside of the model, which reaches from ", low, " to ", high, " m");
  return findStorey(level, options.height - origin);
}
} // namespace
} // namespace plan

FloorPlan drawPlan(const TriangleMesh& mesh, const PlanOptions& options, const Progress& progress)
{
  using namespace plan;
  validate(options);
  validateMesh(mesh);
  require(mesh.faceCount() > 0, "plan: the mesh has no faces");
  report(progress, "floors", 0);
  MeshToCut turned{mesh.vertices, weldedFaces(mesh)};
  const PlanFrame frame = findFrame(mesh.vertices, options, [&](const Points& points) {
    return levelSamples(MeshToCut{points, turned.faces});
  });
  turned.vertices = frame.apply(mesh.vertices);
  const Vector3d origin = turnToZ(options.up) * mesh.origin;
  Building building;
  building.level = levelSamples(turned);
  building.storey = storeyOf(building.level, options, origin.z());
  report(progress, "sections", 0.1);
  building.upright = uprightSamples(turned, building.storey, options.threads);
  report(progress, "rooms", 0.5);
  FloorPlan plan = planOf(building, options, false);
  for (const Eigen::Matrix3Xd& line : cutLines(turned, Vector3d::UnitZ(), building.storey.height))
    plan.section.push_back(line.topRows<2>());
  plan.T_plan_model.linear() = frame.R;
  plan.T_plan_model.translation() = frame.shift + origin - frame.R * mesh.origin;
  place(plan, origin);
  return plan;
}

FloorPlan drawPlan(const PointSet& cloud, const PlanOptions& options, const Progress& progress)
{
  using namespace plan;
  validate(options);
  validatePointSet(cloud);
  const std::vector<Index> finite = finiteColumns(cloud.points);
  require(!finite.empty(), "plan: the cloud has no finite points");
  report(progress, "floors", 0);
  const Points points = cloud.points(Eigen::all, finite);
  const PlanFrame frame = findFrame(points, options, [](const Points& p) { return levelSamples(p); });
  const Points turned = frame.apply(points);
  const Vector3d origin = turnToZ(options.up) * cloud.origin;
  Building building;
  building.level = levelSamples(turned);
  building.storey = storeyOf(building.level, options, origin.z());
  for (Index i = 0; i < turned.cols(); ++i)
    if (turned(2, i) >= building.storey.floor - 0.05 && turned(2, i) <= building.storey.ceiling + 0.05)
      building.upright.push_back(turned.col(i));
  report(progress, "rooms", 0.3);
  FloorPlan plan = planOf(building, options, true);
  plan.T_plan_model.linear() = frame.R;
  plan.T_plan_model.translation() = frame.shift + origin - frame.R * cloud.origin;
  place(plan, origin);
  return plan;
}
} // namespace fresco
