// SPDX-License-Identifier: BSD-3-Clause
#include "report/facts.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/constants.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/pose_file.h>
namespace fresco::model {
namespace {
/// Extent of the rooms, along the first main direction and across.
Eigen::Vector3d sizeOf(const FloorPlan& plan)
{
  const double angle = plan.directions.empty() ? 0 : plan.directions.front() / degrees_per_radian;
  const Eigen::Rotation2Dd turn(-angle);
  Eigen::Array2d low(INFINITY, INFINITY), high = -low;
  double height = 0;
  for (const PlanRoom& room : plan.rooms) {
    const Polyline line = turn.toRotationMatrix() * room.outline;
    low = low.min(line.rowwise().minCoeff().array());
    high = high.max(line.rowwise().maxCoeff().array());
    height = std::max(height, room.ceiling - room.floor);
  }
  if (plan.rooms.empty())
    return Eigen::Vector3d::Zero();
  const Eigen::Array2d extent = high - low;
  return {extent.maxCoeff(), extent.minCoeff(), height};
}

std::vector<std::pair<std::string, Eigen::Vector3d>> standpointsOf(const FloorPlan& plan, const ModelFiles& files)
{
  std::vector<std::pair<std::string, Eigen::Vector3d>> found;
  const std::vector<Pose> poses = readPoses(files.poses);
  for (std::size_t k = 0; k < poses.size(); ++k)
    if (poses[k])
      found.emplace_back(std::to_string(k + 1), plan.T_plan_model * Eigen::Vector3d(poses[k]->topRightCorner<3, 1>()));
  return found;
}

bool isOfScans(const Report& report)
{
  return std::any_of(report.stages.begin(), report.stages.end(),
                     [](const StageRecord& stage) { return stage.figures.contains("scans"); });
}
} // namespace

RoomFacts measureRooms(const Report& report, const ModelFiles& files)
{
  PlanOptions options;
  options.up = report.up;
  RoomFacts facts;
  facts.plan = drawPlan(readMesh(files.mesh), options);
  if (isOfScans(report)) // else the poses are those of thousands of pictures
    facts.standpoints = standpointsOf(facts.plan, files);
  for (const auto& [name, at] : facts.standpoints)
    facts.stations.push_back({at.head<2>(), name});
  facts.size = sizeOf(facts.plan);
  for (const PlanRoom& room : facts.plan.rooms) {
    facts.area += room.area;
    facts.volume += room.area * (room.ceiling - room.floor);
    for (const PlanWall& wall : room.walls) {
      const double length = (wall.to - wall.from).norm();
      facts.walls += length;
      facts.unseen_walls += wall.seen ? 0 : length;
      if (wall.straight)
        facts.wall_deviation = std::max(facts.wall_deviation, wall.worst);
    }
  }
  return facts;
}
} // namespace fresco::model
