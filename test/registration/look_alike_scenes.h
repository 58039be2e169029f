// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "registration/registration_scene.h"
#include <algorithm>
#include <fresco/registration/core/scan_registration.h>
#include <string>
namespace fresco::test {
/// Places that look alike, and counterparts that do not.
struct LookAlikeScene {
  std::string name;
  bool decidable = false; ///< whether the scans hold what tells the places apart: then joining them is right
  ScannedScene scene;
};

enum class Paint { none, same, different }; ///< colours of two rooms

struct FacingRooms {
  bool equal = true;    ///< else furnished differently
  bool between = false; ///< whether a scan was taken in the corridor between them
  bool telling = false; ///< whether something in the corridor can be seen from the rooms
  Paint paint = Paint::none;
};

struct EqualBays {
  bool equal = true; ///< else furnished differently
  bool ends = false; ///< whether the corridor ends behind the first and the last bay, else out of sight
};

/// Distance of a point from the surface of a box, length.
inline double surfaceDistance(const Box& box, const Eigen::Vector3d& point)
{
  const Eigen::Matrix3d R = Eigen::AngleAxisd(-box.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Vector3d d = (R * (point - box.center)).cwiseAbs() - box.half;
  return std::abs(d.cwiseMax(0.0).norm() + std::min(0.0, d.maxCoeff()));
}

/// Gives each point the colour of the box it lies on; the colour follows from `number`, one per box.
inline void paint(PointSet& scan, const Eigen::Isometry3d& T_world_scan, const Boxes& boxes,
                  const std::vector<unsigned>& numbers)
{
  scan.colors.resize(3, scan.size());
  for (Index i = 0; i < scan.size(); ++i) {
    const Eigen::Vector3d point = T_world_scan * scan.points.col(i).cast<double>();
    const auto nearest = std::min_element(boxes.begin(), boxes.end(), [&](const Box& x, const Box& y) {
      return surfaceDistance(x, point) < surfaceDistance(y, point);
    });
    const unsigned hash = (numbers[nearest - boxes.begin()] + 1u) * 2654435761u;
    for (int c = 0; c < 3; ++c)
      scan.colors(c, i) = static_cast<std::uint8_t>(40 + (hash >> (8 * c + 4)) % 176);
  }
}

inline void limitRange(PointSet& scan, float range)
{
  std::vector<Index> near;
  for (Index i = 0; i < scan.size(); ++i)
    if (scan.points.col(i).norm() < range)
      near.push_back(i);
  scan = selectPoints(scan, near);
}

/// Two rooms of 4 x 5 m with open doors on both sides of a corridor; equal ones are each the other turned by half a
/// turn. Two scans in each room.
inline LookAlikeScene facingRooms(const FacingRooms& kind, Index rays = 30000)
{
  const auto turned = [](const Box& box) {
    return Box{{10 - box.center.x(), 4 - box.center.y(), box.center.z()}, box.half, box.yaw};
  };
  Boxes room, other;
  addRoom(room, {0, 0, 0}, {4, 5, 2.6}, 2.0);
  other = room;
  addFurniture(room, {0.3, 0.3, 0}, {3.5, 4.7, 0}, 8, 3);
  addFurniture(other, {0.3, 0.3, 0}, {3.5, 4.7, 0}, 8, kind.equal ? 3 : 17);
  Boxes boxes = room;
  for (const Box& box : other)
    boxes.push_back(turned(box));
  std::vector<unsigned> numbers;
  for (unsigned i = 0; i < boxes.size(); ++i)
    numbers.push_back(kind.paint == Paint::same ? i % static_cast<unsigned>(room.size()) : i);
  addCorridorBetweenRooms(kind.telling, boxes);
  while (numbers.size() < boxes.size())
    numbers.push_back(1000); // the corridor has one colour, whatever the rooms have
  LookAlikeScene made;
  made.scene.truth = {stationPose({1, 1, 1.5}, 0.3, 0.02), stationPose({3, 2.5, 1.5}, 1.3, 0.01),
                      stationPose({9, 1, 1.5}, -2.3, 0.03), stationPose({7.2, 1.4, 1.5}, 2.3, 0.02)};
  if (kind.between)
    made.scene.truth.push_back(stationPose({5.1, 2.1, 1.5}, 0.9, 0.02));
  for (std::size_t i = 0; i < made.scene.truth.size(); ++i) {
    made.scene.scans.push_back(scanBoxes(boxes, made.scene.truth[i], rays, 0.004, static_cast<unsigned>(i) + 1));
    if (kind.paint != Paint::none)
      paint(made.scene.scans.back(), made.scene.truth[i], boxes, numbers);
  }
  made.decidable = !kind.equal || kind.telling || kind.paint == Paint::different;
  made.name = std::string(kind.equal ? "two equal rooms" : "two different rooms") +
              (kind.between ? ", scan between" : "") + (kind.telling ? ", telling thing between" : "") +
              (kind.paint == Paint::same        ? ", equal colours"
               : kind.paint == Paint::different ? ", other colours"
                                                : "");
  return made;
}

/// A corridor with pillars every 3 m and a bench in each bay, seen from six places in six neighbouring bays.
inline LookAlikeScene bays(const EqualBays& kind, Index rays = 30000)
{
  const double length = 3.0;
  const int first = kind.ends ? 0 : -4, last = kind.ends ? 6 : 10;
  Boxes boxes;
  addRoom(boxes, {length * first, 0, 0}, {length * last, 2.4, 2.6}, std::numeric_limits<double>::quiet_NaN());
  for (int bay = first; bay < last; ++bay) {
    const double x = length * bay;
    addBox(boxes, {x + 0.1, 0, 0}, {x + 0.5, 0.3, 2.6});
    addBox(boxes, {x + 0.1, 2.1, 0}, {x + 0.5, 2.4, 2.6});
    if (kind.equal) {
      addBox(boxes, {x + 1.3, 2.0, 0}, {x + 2.4, 2.4, 0.5});
      addBox(boxes, {x + 2.3, 0.0, 0}, {x + 2.7, 0.35, 1.1});
    } else {
      addFurniture(boxes, {x + 0.9, 0.1, 0}, {x + 2.8, 0.35, 0}, 2, static_cast<unsigned>(40 + bay));
      addFurniture(boxes, {x + 0.9, 2.0, 0}, {x + 2.8, 2.3, 0}, 2, static_cast<unsigned>(80 + bay));
    }
  }
  LookAlikeScene made;
  const double along[] = {1.5, 1.1, 1.8, 1.3, 1.6, 0.9}, across[] = {1.2, 1.3, 1.1, 1.25, 1.0, 1.2};
  for (int bay = 0; bay < 6; ++bay) {
    made.scene.truth.push_back(stationPose({length * bay + along[bay], across[bay], 1.5}, 1.1 * bay, 0.02));
    made.scene.scans.push_back(scanBoxes(boxes, made.scene.truth.back(), rays, 0.004, static_cast<unsigned>(bay) + 1));
    if (!kind.ends)
      limitRange(made.scene.scans.back(), 7.f);
  }
  made.decidable = !kind.equal || kind.ends;
  made.name = std::string(kind.equal ? "six equal bays" : "six different bays") + (kind.ends ? ", ends in sight" : "");
  return made;
}

constexpr double row_pitch = 5.1; ///< from one of the rooms in a row to the next, along y

/// Three equal rooms side by side along a corridor, their doors open: a scan in each and one in front of each door.
/// @param telling whether something else stands opposite to each door, so that the rooms' scans show which room is theirs
inline LookAlikeScene roomsInARow(bool telling, Index rays = 30000)
{
  constexpr double pitch = row_pitch;
  Boxes boxes;
  for (int k = 0; k < 3; ++k) {
    addRoom(boxes, {0, pitch * k, 0}, {4, pitch * k + 5, 2.6}, pitch * k + 2);
    addFurniture(boxes, {0.3, pitch * k + 0.3, 0}, {3.5, pitch * k + 4.7, 0}, 8, 3);
    if (telling)
      addFurniture(boxes, {5.3, pitch * k + 1.2, 0}, {5.7, pitch * k + 2.8, 0}, 3, 50 + static_cast<unsigned>(k));
  }
  addBox(boxes, {4.0, -1.1, -0.1}, {6, 3 * pitch, 0});
  addBox(boxes, {4.0, -1.1, 2.6}, {6, 3 * pitch, 2.7});
  addBox(boxes, {6.0, -1.1, 0}, {6.1, 3 * pitch, 2.6});
  addBox(boxes, {4.0, -1.1, 0}, {6, -1, 2.6});
  addBox(boxes, {4.0, 3 * pitch, 0}, {6, 3 * pitch + 0.1, 2.6});
  addBox(boxes, {4.0, -1.1, 0}, {4.1, 0, 2.6});
  LookAlikeScene made;
  for (int k = 0; k < 3; ++k) {
    made.scene.truth.push_back(stationPose({1.2 + 0.6 * k, pitch * k + 2.6 - 0.5 * k, 1.5}, 0.9 * k, 0.02));
    made.scene.truth.push_back(stationPose({4.9, pitch * k + 1.8 + 0.2 * k, 1.5}, 0.4 + k, 0.02));
  }
  for (std::size_t i = 0; i < made.scene.truth.size(); ++i)
    made.scene.scans.push_back(scanBoxes(boxes, made.scene.truth[i], rays, 0.004, static_cast<unsigned>(i) + 1));
  made.decidable = telling;
  made.name = std::string("three equal rooms in a row") + (telling ? ", telling things opposite" : "");
  return made;
}

/// All of them: what looks alike, and what only seems to.
inline std::vector<LookAlikeScene> lookAlikeScenes(Index rays = 30000)
{
  std::vector<LookAlikeScene> scenes;
  for (const bool between : {false, true})
    for (const bool telling : {false, true})
      scenes.push_back(facingRooms({true, between, telling, Paint::none}, rays));
  for (const Paint paint : {Paint::same, Paint::different})
    for (const bool between : {false, true})
      scenes.push_back(facingRooms({true, between, false, paint}, rays));
  for (const bool between : {false, true})
    scenes.push_back(facingRooms({false, between, false, Paint::none}, rays));
  for (const bool telling : {false, true})
    scenes.push_back(roomsInARow(telling, rays));
  for (const bool equal : {true, false})
    for (const bool ends : {false, true})
      scenes.push_back(bays({equal, ends}, rays));
  return scenes;
}

/// Pairs that a result holds together.
struct HeldPairs {
  int right = 0, wrong = 0; ///< of scans in one group, by the poses within it; those said to slide may be off by more
};

inline HeldPairs heldPairs(const ScanRegistrationResult& result, const ScannedScene& scene)
{
  HeldPairs held;
  for (const PairResult& pair : result.pairs) {
    const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
    if (!pair.accepted || result.scans[a].group != result.scans[b].group)
      continue;
    const Eigen::Isometry3d found(result.scans[a].T_group_scan.inverse() * result.scans[b].T_group_scan),
        truth = scene.truth[a].inverse() * scene.truth[b];
    const bool slides = result.scans[a].free_motion || result.scans[b].free_motion;
    const bool right = (found.matrix() - truth.matrix()).norm() < (slides ? 0.3 : 0.05);
    ++(right ? held.right : held.wrong);
  }
  return held;
}
} // namespace fresco::test
