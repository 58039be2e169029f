// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <fresco/core/point_set.h>
#include <limits>
#include <random>
#include <vector>
namespace fresco::test {
/// A box turned about the vertical.
struct Box {
  Eigen::Vector3d center, half;
  double yaw = 0.0;

  /// Distance along the ray to the box, infinity if it misses; the ray starts outside.
  double hit(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) const
  {
    const Eigen::Matrix3d R = Eigen::AngleAxisd(-yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const Eigen::Vector3d o = R * (from - center), d = R * direction;
    double near = 0.0, far = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      const double a = (-half[k] - o[k]) / d[k], b = (half[k] - o[k]) / d[k];
      near = std::max(near, std::min(a, b));
      far = std::min(far, std::max(a, b));
    }
    return near < far && near > 0.0 ? near : std::numeric_limits<double>::infinity();
  }
};

using Boxes = std::vector<Box>;

/// Adds a box given by two corners.
inline void addBox(Boxes& boxes, const Eigen::Vector3d& low, const Eigen::Vector3d& high, double yaw = 0.0)
{
  boxes.push_back({(low + high) / 2, (high - low) / 2, yaw});
}

/// Floor, ceiling and four walls around `low` .. `high`; the wall at x = high.x has a door of 1 m x 2.1 m at y =
/// `door`, none if `door` is NaN.
inline void addRoom(Boxes& boxes, const Eigen::Vector3d& low, const Eigen::Vector3d& high, double door)
{
  const double w = 0.1;
  addBox(boxes, {low.x() - w, low.y() - w, low.z() - w}, {high.x() + w, high.y() + w, low.z()});
  addBox(boxes, {low.x() - w, low.y() - w, high.z()}, {high.x() + w, high.y() + w, high.z() + w});
  addBox(boxes, {low.x() - w, low.y() - w, low.z()}, {low.x(), high.y() + w, high.z()});
  addBox(boxes, {low.x(), low.y() - w, low.z()}, {high.x(), low.y(), high.z()});
  addBox(boxes, {low.x(), high.y(), low.z()}, {high.x(), high.y() + w, high.z()});
  if (std::isnan(door)) {
    addBox(boxes, {high.x(), low.y() - w, low.z()}, {high.x() + w, high.y() + w, high.z()});
    return;
  }
  addBox(boxes, {high.x(), low.y() - w, low.z()}, {high.x() + w, door - 0.5, high.z()});
  addBox(boxes, {high.x(), door + 0.5, low.z()}, {high.x() + w, high.y() + w, high.z()});
  addBox(boxes, {high.x(), door - 0.5, low.z() + 2.1}, {high.x() + w, door + 0.5, high.z()});
}

/// Boxes of furniture size on the floor between `low` and `high`, none above 1.2 m.
inline void addFurniture(Boxes& boxes, const Eigen::Vector3d& low, const Eigen::Vector3d& high, int count,
                         unsigned seed)
{
  std::mt19937 random(seed);
  const auto uniform = [&](double a, double b) { return a + (b - a) * (random() / 4294967296.0); };
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d half(uniform(0.1, 0.6), uniform(0.1, 0.4), uniform(0.15, 0.6));
    const Eigen::Vector3d center(uniform(low.x(), high.x()), uniform(low.y(), high.y()), low.z() + half.z());
    boxes.push_back({center, half, uniform(0.0, M_PI)});
  }
}

/// Two rooms of 5 x 4 and 4 x 4 m that share a door, furnished.
inline Boxes twoRooms()
{
  Boxes boxes;
  addRoom(boxes, {0, 0, 0}, {5, 4, 2.6}, 1.5);
  addRoom(boxes, {5.1, 0, 0}, {9, 4.5, 2.6}, std::numeric_limits<double>::quiet_NaN());
  boxes.erase(boxes.begin() + 8 + 2); // the second room's own wall at x = 5.1 would close the door
  addFurniture(boxes, {0.3, 0.3, 0}, {4.7, 3.7, 0}, 8, 3);
  addFurniture(boxes, {5.6, 0.3, 0}, {8.7, 4.2, 0}, 7, 4);
  return boxes;
}

/// What a scanner at `T_world_scan` measures: rays over the whole sphere but a cone below, noise along the ray.
inline PointSet scanBoxes(const Boxes& boxes, const Eigen::Isometry3d& T_world_scan, Index rays, double noise,
                          unsigned seed)
{
  std::mt19937 random(seed);
  std::normal_distribution<double> error(0.0, noise > 0.0 ? noise : 1.0);
  PointSet scan;
  scan.points.resize(3, rays);
  Index count = 0;
  for (Index i = 0; i < rays; ++i) {
    // Fibonacci sphere.
    const double z = 1.0 - 2.0 * (static_cast<double>(i) + 0.5) / static_cast<double>(rays);
    const double angle = static_cast<double>(i) * M_PI * (3.0 - std::sqrt(5.0)), r = std::sqrt(1.0 - z * z);
    const Eigen::Vector3d direction(r * std::cos(angle), r * std::sin(angle), z);
    if (z < -0.9)
      continue;
    double range = std::numeric_limits<double>::infinity();
    for (const Box& box : boxes)
      range = std::min(range, box.hit(T_world_scan.translation(), T_world_scan.linear() * direction));
    if (std::isinf(range))
      continue;
    scan.points.col(count++) = ((range + (noise > 0.0 ? error(random) : 0.0)) * direction).cast<float>();
  }
  scan.points.conservativeResize(3, count);
  scan.viewpoints = Points::Zero(3, 1);
  return scan;
}

inline Eigen::Isometry3d stationPose(const Eigen::Vector3d& place, double yaw, double tilt)
{
  return Eigen::Translation3d(place) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX());
}
} // namespace fresco::test
