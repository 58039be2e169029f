// SPDX-License-Identifier: BSD-3-Clause
#include "scan/people.h"
#include <algorithm>
#include <fresco/core/union_find.h>
namespace fresco::registration {
namespace {
// Of the scanner's height over the floor, about 1.6 m on a tripod: chests begin at 1.1 m, heads end at 1.3 to 2 m.
constexpr float chest = 0.7f, least_top = 0.8f, most_top = 1.25f, least_height = 0.2f, most_width = 0.45f;
constexpr float floor_layer = 0.08f, radius = 0.3f; // of what is below: feet and elbows

// Whether most neighbours of a point lie in its plane.
bool liesInPlane(const ScanLevel& level, Index point)
{
  constexpr float parallel = 0.97f, off = 0.25f; // cosine of 14 degrees; voxels
  constexpr int least = 6;                       // of seven
  int in_plane = 0;
  for (int n = 1; n < level.around.rows(); ++n) { // the first is the point itself
    const std::int32_t k = level.around(n, point);
    if (k < 0)
      continue;
    const auto normal = level.normals.col(point);
    in_plane += std::abs(normal.dot(level.normals.col(k))) > parallel &&
                std::abs(normal.dot(level.points.col(k) - level.points.col(point))) < off * level.voxel;
  }
  return in_plane >= least;
}

// Whether a neighbour of a point (-1 = none) is one of the given points and hangs together with it.
bool isLinked(const ScanLevel& level, const std::vector<char>& given, Index point, std::int32_t neighbour)
{
  constexpr float gap = 2.f; // voxels
  return neighbour >= 0 && given[neighbour] != 0 &&
         (level.points.col(point) - level.points.col(neighbour)).norm() < gap * level.voxel;
}

bool hasLinked(const ScanLevel& level, const std::vector<char>& given, Index point)
{
  const auto around = level.around.col(point);
  return std::any_of(around.begin(), around.end(), [&](std::int32_t k) { return isLinked(level, given, point, k); });
}

// The given points in sets that hang together.
UnionFind connect(const ScanLevel& level, const std::vector<char>& given)
{
  UnionFind sets(level.points.cols());
  for (Index i = 0; i < level.points.cols(); ++i)
    for (int n = 1; given[i] != 0 && n < level.around.rows(); ++n)
      if (isLinked(level, given, i, level.around(n, i)))
        sets.join(i, level.around(n, i));
  return sets;
}

bool isPerson(const Eigen::AlignedBox3f& box, float height)
{
  const float top = box.max().z() / height;
  const Eigen::Vector3f size = box.sizes() / height;
  return top > least_top && top < most_top && size.z() > least_height && size.head<2>().maxCoeff() < most_width;
}

// Boxes around sets of the given points, at the roots of the sets.
std::vector<Eigen::AlignedBox3f> boxesOf(UnionFind& sets, const std::vector<char>& given, const Points& placed)
{
  std::vector<Eigen::AlignedBox3f> boxes(given.size());
  for (std::size_t i = 0; i < given.size(); ++i)
    if (given[i] != 0)
      boxes[sets.root(i)].extend(Eigen::Vector3f(placed.col(i)));
  return boxes;
}

// Points of flat surfaces that are larger than a person: of walls, cupboards and doors.
std::vector<char> findWalls(const ScanLevel& level, const Points& placed, float height)
{
  std::vector<char> found(placed.cols());
  for (Index i = 0; i < placed.cols(); ++i)
    found[i] = liesInPlane(level, i);
  UnionFind sets = connect(level, found);
  const std::vector<Eigen::AlignedBox3f> boxes = boxesOf(sets, found, placed);
  for (Index i = 0; i < placed.cols(); ++i) {
    const Eigen::AlignedBox3f& box = boxes[sets.root(i)];
    found[i] =
        found[i] != 0 && (box.sizes().head<2>().maxCoeff() > most_width * height || box.max().z() > most_top * height);
  }
  return found;
}

// Of the heads and chests.
std::vector<Eigen::AlignedBox3f> personBoxes(const ScanLevel& level, const Points& placed, float height)
{
  constexpr Index fewest = 4;
  constexpr double most_at_wall = 0.5; // of the points: more, and they are the edge of a cupboard or a door
  const Index n = placed.cols();
  const std::vector<char> walls = findWalls(level, placed, height);
  std::vector<char> given(n);
  for (Index i = 0; i < n; ++i)
    given[i] = placed(2, i) > chest * height && walls[i] == 0;
  UnionFind sets = connect(level, given);
  const std::vector<Eigen::AlignedBox3f> boxes = boxesOf(sets, given, placed);
  std::vector<Index> counts(n, 0), at_wall(n, 0); // of sets, at their roots
  for (Index i = 0; i < n; ++i)
    if (given[i] != 0) {
      ++counts[sets.root(i)];
      at_wall[sets.root(i)] += hasLinked(level, walls, i) ? 1 : 0;
    }
  std::vector<Eigen::AlignedBox3f> people;
  for (Index i = 0; i < n; ++i)
    if (counts[i] >= fewest && at_wall[i] <= most_at_wall * counts[i] && isPerson(boxes[i], height))
      people.push_back(boxes[i]);
  return people;
}
} // namespace

std::vector<char> findPeople(const PreparedScan& scan, const PlanFrame& frame)
{
  const ScanLevel& level = scan.levels[check_level];
  const Points placed = frame.T_plan_scan * level.points;
  std::vector<char> found(placed.cols(), 0);
  for (const Eigen::AlignedBox3f& person : personBoxes(level, placed, frame.height))
    for (Index i = 0; i < placed.cols(); ++i)
      if (placed(2, i) > floor_layer * frame.height && placed(2, i) < person.max().z() + 0.25f * level.voxel &&
          (placed.col(i) - person.center()).head<2>().norm() < radius * frame.height)
        found[i] = 1;
  return found;
}
} // namespace fresco::registration
