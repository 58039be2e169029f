// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "registration/synthetic_rooms.h"
#include <fresco/io/pose_file.h>
namespace fresco::test {
struct ScannedScene {
  std::vector<PointSet> scans;
  std::vector<Eigen::Isometry3d, Eigen::aligned_allocator<Eigen::Isometry3d>> truth; ///< world from scan
};

/// Two furnished rooms that share a door, seen from three places in the first and two in the second.
inline ScannedScene scanTwoRooms(Index rays = 20000, double noise = 0.004)
{
  const Boxes boxes = twoRooms();
  ScannedScene scene;
  scene.truth = {stationPose({1, 1, 1.5}, 0.3, 0.02), stationPose({3.8, 1.2, 1.5}, 1.3, 0.01),
                 stationPose({2.5, 3.3, 1.6}, -2.3, 0.03), stationPose({6, 1.5, 1.5}, 2.3, 0.02),
                 stationPose({7.5, 3, 1.5}, 0.9, 0.02)};
  for (std::size_t i = 0; i < scene.truth.size(); ++i)
    scene.scans.push_back(scanBoxes(boxes, scene.truth[i], rays, noise, static_cast<unsigned>(i) + 1));
  return scene;
}

/// Two niches side by side at a long bare corridor, two stations in each (0, 1 and 2, 3). From one niche nothing of the
/// other is seen: all that they share is the corridor, which is the same all along x.
inline ScannedScene scanNiches(Index rays = 20000)
{
  Boxes boxes;
  addBox(boxes, {-40, -1, -0.1}, {40, 5, 0});
  addBox(boxes, {-40, -1, 2.6}, {40, 5, 2.7});
  addBox(boxes, {-40, -0.1, 0}, {40, 0, 2.6});
  addBox(boxes, {-40, 4, 0}, {40, 4.1, 2.6});
  for (const auto& [from, to] : {std::pair(-40.0, -2.5), std::pair(-0.5, 0.5), std::pair(2.5, 40.0)})
    addBox(boxes, {from, 2, 0}, {to, 4, 2.6});
  addFurniture(boxes, {-2.3, 3.2, 0}, {-0.7, 3.8, 0}, 3, 3);
  addFurniture(boxes, {0.7, 3.2, 0}, {2.3, 3.8, 0}, 3, 4);
  ScannedScene scene;
  scene.truth = {stationPose({-1.6, 2.4, 1.5}, 0.3, 0.02), stationPose({-1.1, 2.6, 1.4}, 1.3, 0.01),
                 stationPose({1.5, 2.4, 1.5}, -2.3, 0.03), stationPose({1.9, 2.6, 1.4}, 2.3, 0.02)};
  for (std::size_t i = 0; i < scene.truth.size(); ++i)
    scene.scans.push_back(scanBoxes(boxes, scene.truth[i], rays, 0.004, static_cast<unsigned>(i) + 1));
  return scene;
}

/// Corridor between two rooms that face each other; `telling`: with something in it that the rooms can see.
inline void addCorridorBetweenRooms(bool telling, Boxes& boxes)
{
  addBox(boxes, {4.0, -4, -0.1}, {6, 8, 0});
  addBox(boxes, {4.0, -4, 2.6}, {6, 8, 2.7});
  addBox(boxes, {4.0, -4.1, 0}, {6, -4, 2.6});
  addBox(boxes, {4.0, 8, 0}, {6, 8.1, 2.6});
  addBox(boxes, {4.0, 5, 0}, {4.1, 8, 2.6});
  addBox(boxes, {4.0, -4, 0}, {4.1, 0, 2.6});
  addBox(boxes, {5.9, 4, 0}, {6, 8, 2.6});
  addBox(boxes, {5.9, -4, 0}, {6, -1, 2.6});
  if (telling)
    addBox(boxes, {5.4, 2.7, 0}, {5.9, 3.5, 1.9});
}

/// Two equal furnished rooms on both sides of a corridor, each the other turned by half a turn, seen from two places in
/// each and one in the corridor. The doors stand open.
/// @param telling whether something stands in the corridor that can be seen from the rooms: without it, nothing in the
/// scans says which of the rooms a scan was taken in
inline ScannedScene scanTwinRooms(bool telling, Index rays = 30000)
{
  Boxes room, boxes;
  addRoom(room, {0, 0, 0}, {4, 5, 2.6}, 2.0);
  addFurniture(room, {0.3, 0.3, 0}, {3.5, 4.7, 0}, 8, 3);
  for (const Box& box : room) {
    boxes.push_back(box);
    boxes.push_back({{10 - box.center.x(), 4 - box.center.y(), box.center.z()}, box.half, box.yaw});
  }
  addCorridorBetweenRooms(telling, boxes);
  ScannedScene scene;
  scene.truth = {stationPose({1, 1, 1.5}, 0.3, 0.02), stationPose({3, 2.5, 1.5}, 1.3, 0.01),
                 stationPose({9, 1, 1.5}, -2.3, 0.03), stationPose({7.2, 1.4, 1.5}, 2.3, 0.02),
                 stationPose({5.1, 2.1, 1.5}, 0.9, 0.02)};
  for (std::size_t i = 0; i < scene.truth.size(); ++i)
    scene.scans.push_back(scanBoxes(boxes, scene.truth[i], rays, 0.004, static_cast<unsigned>(i) + 1));
  return scene;
}

/// `truth` moved by `offset` metres and `degrees` in directions that follow from the number of the scan.
inline std::vector<Pose> disturbed(const ScannedScene& scene, double offset, double degrees)
{
  std::vector<Pose> poses;
  std::mt19937 random(5);
  const auto unit = [&] {
    Eigen::Vector3d v;
    do
      for (int k = 0; k < 3; ++k)
        v[k] = 2.0 * (random() / 4294967296.0) - 1.0;
    while (v.norm() > 1.0 || v.norm() < 0.1);
    return Eigen::Vector3d(v.normalized());
  };
  for (const Eigen::Isometry3d& T : scene.truth) {
    const Eigen::Vector3d shift = offset * unit();
    poses.push_back((T * Eigen::Translation3d(shift) * Eigen::AngleAxisd(degrees * M_PI / 180.0, unit())).matrix());
  }
  return poses;
}

/// Largest errors of the relative poses against the first placed scan.
struct PoseError {
  double translation = 0.0; ///< metres
  double degrees = 0.0;
};

inline PoseError relativeError(const std::vector<Pose>& poses, const ScannedScene& scene)
{
  PoseError error;
  std::size_t first = 0;
  while (first < poses.size() && !poses[first])
    ++first;
  for (std::size_t i = first; i < poses.size(); ++i) {
    if (!poses[i])
      continue;
    const Eigen::Isometry3d found(poses[first]->inverse() * *poses[i]),
        truth = scene.truth[first].inverse() * scene.truth[i];
    const Eigen::Isometry3d difference = truth.inverse() * found;
    error.translation = std::max(error.translation, difference.translation().norm());
    error.degrees = std::max(error.degrees, Eigen::AngleAxisd(difference.linear()).angle() * 180.0 / M_PI);
  }
  return error;
}
} // namespace fresco::test
