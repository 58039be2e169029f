// SPDX-License-Identifier: BSD-3-Clause
#include "fusion/surface_points.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
namespace fresco::fusion {
namespace {
constexpr int halo_side = brick_side + 1;

/// Nodes of a brick and the next ones along each axis; 0 weight where there are none.
struct Halo {
  std::array<float, halo_side * halo_side * halo_side> distance{}, weight{};

  Halo(const DistanceGrid& grid, Index b)
  {
    for (int o = 0; o < 8; ++o) {
      const Eigen::Vector3i offset(o & 1, o >> 1 & 1, o >> 2);
      const Index from = o == 0 ? b : grid.find(grid.place(b) + offset);
      if (from < 0)
        continue;
      const Eigen::Vector3i end = brick_side * (Eigen::Vector3i::Ones() - offset) + offset;
      for (int z = 0; z < end.z(); ++z)
        for (int y = 0; y < end.y(); ++y)
          for (int x = 0; x < end.x(); ++x) {
            const int to = at(x + brick_side * offset.x(), y + brick_side * offset.y(), z + brick_side * offset.z());
            const int node = nodeIndex(x, y, z);
            distance[to] = grid.brick(from).distance[node];
            weight[to] = grid.brick(from).weight[node];
          }
    }
  }

  static int at(int x, int y, int z) { return x + halo_side * (y + halo_side * z); }
};

struct SurfacePoint {
  Eigen::Vector3f position, normal;
  float weight;
};

/// Of the cell whose lower corner is node (x, y, z), in cells of the brick; false where the surface is not.
bool pointOfCell(const Halo& halo, int x, int y, int z, SurfacePoint& point)
{
  float d[8], weight = 0;
  int inside = 0;
  for (int k = 0; k < 8; ++k) {
    const int at = Halo::at(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2));
    if (halo.weight[at] <= 0.f)
      return false;
    d[k] = halo.distance[at];
    weight += halo.weight[at] / 8;
    inside += d[k] < 0.f;
  }
  if (inside == 0 || inside == 8)
    return false;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero(), gradient = Eigen::Vector3f::Zero();
  int crossings = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 0; k < 8; ++k) {
      if (k >> axis & 1)
        continue;
      const float a = d[k], b = d[k | 1 << axis];
      gradient[axis] += b - a;
      if ((a < 0.f) == (b < 0.f))
        continue;
      Eigen::Vector3f crossing(k & 1, k >> 1 & 1, k >> 2);
      crossing[axis] = a / (a - b);
      sum += crossing;
      ++crossings;
    }
  const float length = gradient.norm();
  if (!(length > 0.f))
    return false;
  point = {sum / crossings + Eigen::Vector3f(x, y, z), gradient / length, weight};
  return true;
}

std::vector<SurfacePoint> pointsOfBrick(const DistanceGrid& grid, Index b)
{
  std::vector<SurfacePoint> points;
  const Halo halo(grid, b);
  const Eigen::Vector3f corner = (brick_side * grid.place(b)).cast<float>();
  SurfacePoint point;
  for (int z = 0; z < brick_side; ++z)
    for (int y = 0; y < brick_side; ++y)
      for (int x = 0; x < brick_side; ++x)
        if (pointOfCell(halo, x, y, z, point)) {
          point.position = grid.cell() * (corner + point.position);
          points.push_back(point);
        }
  return points;
}
} // namespace

PointSet surfacePoints(const DistanceGrid& grid, int threads)
{
  std::vector<std::vector<SurfacePoint>> parts(grid.size());
  parallelFor(grid.size(), threads, [&](Index b) { parts[b] = pointsOfBrick(grid, b); });
  Index count = 0;
  for (const auto& part : parts)
    count += part.size();
  PointSet set;
  set.points.resize(3, count);
  set.normals.resize(3, count);
  set.viewpoints.resize(3, count);
  set.confidences.resize(count);
  Index i = 0;
  for (Index b = 0; b < grid.size(); ++b)
    for (const SurfacePoint& point : parts[b]) {
      set.points.col(i) = point.position;
      set.normals.col(i) = point.normal;
      set.viewpoints.col(i) = grid.viewpoint(b);
      set.confidences[i++] = point.weight;
    }
  return set;
}
} // namespace fresco::fusion
