// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "report/report.h"
#include <fresco/deliverables/core/plan_drawing.h>
namespace fresco::model {
/// What the owner of a room wants to know, measured on the finished mesh; metres.
struct RoomFacts {
  FloorPlan plan;
  std::vector<PlanMark> stations;                                   ///< where scans were taken, in the plan
  std::vector<std::pair<std::string, Eigen::Vector3d>> standpoints; ///< the same with names and heights
  Eigen::Vector3d size = {0, 0, 0};   ///< of all rooms along the main direction of the walls, across, and up
  double area = 0, volume = 0;        ///< square metres, cubic metres, of all rooms
  double unseen_walls = 0, walls = 0; ///< lengths of outlines: without data, and all
  double wall_deviation = 0;          ///< 95 % of the data of straight walls are nearer to them
};

RoomFacts measureRooms(const Report& report, const ModelFiles& files);
} // namespace fresco::model
