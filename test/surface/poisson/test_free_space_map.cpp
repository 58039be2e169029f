// SPDX-License-Identifier: BSD-3-Clause
#include "surface/poisson/volumetric_shapes.h"
#include "thread_ranks.h"
#include <algorithm>
#include <fresco/core/mesh.h>
#include <fresco/search/neighbors.h>
#include <fresco/surface/core/free_space_map.h>
#include <gtest/gtest.h>
namespace fresco::test {
namespace {
/// Sets of points, one after the other.
class Sets : public PointStream {
public:
  explicit Sets(std::vector<PointSet> sets) : sets_(std::move(sets)) {}
  void read(const std::function<void(const PointSet&)>& receive) const override
  {
    for (const PointSet& set : sets_)
      receive(set);
  }

private:
  std::vector<PointSet> sets_;
};

/// A room, the unit sphere from inside.
PointSet room(Index count, const Eigen::Vector3f& viewpoint)
{
  PointSet set = sphere(count);
  set.normals = -set.points;
  set.viewpoints.resize(3, 1);
  set.viewpoints.col(0) = viewpoint;
  return set;
}

template <typename Keep>
PointSet filtered(const PointSet& set, const Keep& keep)
{
  std::vector<Index> kept;
  for (Index i = 0; i < set.size(); ++i)
    if (keep(set.points.col(i)))
      kept.push_back(i);
  return selectPoints(set, kept);
}

/// A can in the room, open towards +x, of which no scan shows what is behind the opening.
PointSet openCan()
{
  constexpr int around = 120, along = 40, rings = 20;
  constexpr float radius = 0.2f, length = 0.3f;
  std::vector<Eigen::Vector3f> points, normals;
  for (int i = 0; i < around; ++i) {
    const float a = 2 * float(pi) * i / around;
    const Eigen::Vector3f out(0, std::cos(a), std::sin(a));
    for (int k = 0; k < along; ++k) {
      points.push_back(radius * out - Eigen::Vector3f(length * k / along, 0, 0));
      normals.push_back(out);
    }
    for (int k = 1; k < rings; ++k) {
      points.push_back(radius * k / rings * out - Eigen::Vector3f(length, 0, 0));
      normals.push_back(-Eigen::Vector3f::UnitX());
    }
  }
  PointSet set;
  set.points.resize(3, points.size());
  set.normals.resize(3, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    set.points.col(i) = points[i];
    set.normals.col(i) = normals[i];
  }
  return set;
}

/// What a station beside the opening of the can sees: walls, where the can is not before them.
PointSet besideTheCan()
{
  const Eigen::Vector3f station(0.12f, 0.f, 0.9f);
  return filtered(room(40000, station), [&](const Eigen::Vector3f& p) {
    for (float t = 0; t < 1; t += 0.002f) {
      const Eigen::Vector3f q = station + t * (p - station);
      if (q.x() < 0.02f && q.x() > -0.32f && q.tail<2>().norm() < 0.22f)
        return false;
    }
    return true;
  });
}

PointSet roomWithCan()
{
  PointSet set = room(40000, {0, 0, 0});
  set.viewpoints.resize(3, 0);
  return mergePoints(set, openCan());
}

/// Vertices where beams passed, two cells and more before what they hit, five and more beside the points.
Index verticesInFreeSpace(const VolumetricResult& result, const PointSet& points, const FreeSpaceMap& map)
{
  const PointTree tree(points.points);
  Index count = 0;
  for (Index v = 0; v < result.mesh.vertexCount(); ++v) {
    const Eigen::Vector3f place = result.mesh.vertices.col(v);
    count += tree.nearest(place, 5 * result.cell_size).index < 0 &&
             map.isFree(result.mesh.origin + place.cast<double>(), 2 * result.cell_size);
  }
  return count;
}

/// A ball in the room, of which a station in the middle sees the near half.
PointSet ballInTheRoom(float radius)
{
  const Eigen::Vector3f middle(0, 0, -0.4f);
  PointSet half = filtered(sphere(3000), [](const Eigen::Vector3f& p) { return p.z() > 0.1f; });
  half.points = (radius * half.points).colwise() + middle;
  half.viewpoints.setZero(3, 1);
  const PointSet walls = filtered(room(40000, {0, 0, 0}), [&](const Eigen::Vector3f& p) {
    return p.z() > 0 || p.cross(middle).norm() > radius * p.norm();
  });
  return mergePoints(walls, half);
}

VolumetricOptions withMap(int depth, const FreeSpaceMap& map)
{
  VolumetricOptions options = atDepth(depth);
  options.free_space = std::make_shared<FreeSpaceMap>(map);
  return options;
}

TEST(FreeSpaceMap, FreeIsWhatLiesBeforeTheEndsOfBeams)
{
  const Eigen::Vector3f viewpoint(0.3f, -0.2f, 0.1f);
  PointSet beams = filtered(room(20000, viewpoint), [](const Eigen::Vector3f& p) { return p.x() < 0.8f; }); // a window
  beams.origin = {4e6, 5e5, 100};
  const FreeSpaceMap map(Sets({beams}));
  EXPECT_EQ(map.stations(), 1);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  double asked = 0, free = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d direction = Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    EXPECT_FALSE(map.isFree(beams.origin + 0.97 * direction, 0.05)) << direction.transpose();
    EXPECT_FALSE(map.isFree(beams.origin + 1.2 * direction, 0.05)) << direction.transpose();
    if (direction.x() < 0.6) {
      ++asked;
      free += map.isFree(beams.origin + 0.8 * direction, 0.05);
    }
  }
  EXPECT_GT(free, 0.9 * asked); // here and there beams leave too many bins empty
  EXPECT_FALSE(map.isFree(beams.origin + Eigen::Vector3d(0.9, 0, 0), 0.01)) << "nothing came back from there";
}

TEST(FreeSpaceMap, OrderAndWindowsDoNotMatter)
{
  const PointSet all = room(20001, {0.3f, 0, 0});
  std::vector<Index> back;
  for (Index i = all.size() - 1; i >= 0; --i)
    back.push_back(i);
  const PointSet reversed = selectPoints(all, back);
  std::vector<Index> first(back.end() - 7000, back.end()), rest(back.begin(), back.end() - 7000);
  const FreeSpaceMap whole(Sets({all})), windows(Sets({selectPoints(all, first), selectPoints(all, rest)}));
  int free = 0;
  for (int i = 0; i < 10000; ++i) {
    const Eigen::Vector3d place = 1.1 * Eigen::Vector3d::Random();
    EXPECT_EQ(whole.isFree(place, 0.05), windows.isFree(place, 0.05));
    free += whole.isFree(place, 0.05);
  }
  EXPECT_GT(free, 2000) << "most of the inside of the room";
  EXPECT_LT(free, 8000) << "not what lies behind its walls";
}

TEST(FreeSpaceMap, WhatOneStationFoundAnotherMustNotSeeThrough)
{
  const Eigen::Vector3d place(0.5, 0, 0);
  PointSet thing = room(20000, {0, 0, 0});
  thing.points *= 0.5f;
  const PointSet wall = room(20000, {0.01f, 0, 0}), other_wall = room(20000, {0, 0.01f, 0}),
                 third = room(20000, {0, 0, 0.01f});
  EXPECT_TRUE(FreeSpaceMap(Sets({wall})).isFree(place, 0.02));
  EXPECT_FALSE(FreeSpaceMap(Sets({wall, thing})).isFree(place, 0.02));
  EXPECT_TRUE(FreeSpaceMap(Sets({wall, thing, other_wall, third})).isFree(place, 0.02)) << "three of four saw through";
}

TEST(FreeSpaceMap, WhatMovedHidesWhatItMayHaveReached)
{
  const Eigen::Vector3d before(0.3, 0, 0), behind(0.7, 0, 0);
  PointSet thing = room(20000, {0, 0, 0});
  thing.points *= 0.5f;
  std::vector<PointSet> sets{thing};
  for (const Eigen::Vector3f& place : {Eigen::Vector3f(0.01f, 0, 0), {0, 0.01f, 0}, {0, 0, 0.01f}}) {
    sets.push_back(room(20000, place));
    const FreeSpaceMap map((Sets(sets)));
    EXPECT_TRUE(map.isFree(before, 0.02)) << map.stations();
    EXPECT_EQ(map.isFree(behind, 0.02), map.stations() == 4) << "three against one";
  }
  EXPECT_TRUE(FreeSpaceMap(Sets({sets[1]})).isFree(behind, 0.02));
}

TEST(FreeSpaceMap, WithoutStationsItSaysSo)
{
  PointSet beams = room(5000, {0, 0, 0});
  beams.viewpoints = 0.01f * beams.points;
  EXPECT_THROW(FreeSpaceMap(Sets({beams})), std::invalid_argument) << "a viewpoint each";
  beams.viewpoints.resize(3, 0);
  EXPECT_THROW(FreeSpaceMap(Sets({beams})), std::invalid_argument);
}

TEST(FreeSpaceReconstruction, NoSurfaceWhereBeamsPassed)
{
  const PointSet points = roomWithCan();
  const FreeSpaceMap map(Sets({besideTheCan()}));
  for (const int depth : {7, 8}) {
    const VolumetricResult plain = reconstructVolumetric(points, atDepth(depth));
    const VolumetricResult result = reconstructVolumetric(points, withMap(depth, map));
    EXPECT_GT(verticesInFreeSpace(plain, points, map), 20) << depth; // else nothing is shown
    EXPECT_LT(verticesInFreeSpace(result, points, map), verticesInFreeSpace(plain, points, map) / 3) << depth;
    const MeshTopology topology = meshTopology(result.mesh);
    EXPECT_TRUE(topology.watertight) << depth;
    EXPECT_EQ(topology.nonmanifold_edges, 0) << depth;
    EXPECT_EQ(topology.components, 2) << depth << ": the room and the can";
  }
}

TEST(FreeSpaceReconstruction, WhatMovedKeepsItsSurface)
{
  const PointSet with_ball = ballInTheRoom(0.12f), without = room(40000, {0.3f, 0.2f, 0.1f});
  const FreeSpaceMap map(Sets({with_ball, without}));
  const PointSet points = mergePoints(with_ball, without);
  for (const int depth : {5, 6, 7})
    EXPECT_EQ(reconstructVolumetric(points, atDepth(depth)).mesh.vertices,
              reconstructVolumetric(points, withMap(depth, map)).mesh.vertices)
        << depth << ": one against one";
}

TEST(FreeSpaceReconstruction, WhereBeamsAgreeNothingChanges)
{
  const PointSet points = room(40000, {0.2f, 0.1f, 0.f});
  const FreeSpaceMap map(Sets({points}));
  const TriangleMesh plain = reconstructVolumetric(points, atDepth(7)).mesh;
  const TriangleMesh asked = reconstructVolumetric(points, withMap(7, map)).mesh;
  EXPECT_EQ(plain.vertices, asked.vertices);
  EXPECT_EQ(plain.faces, asked.faces);
}

TEST(FreeSpaceReconstruction, ThreadsDoNotMatter)
{
  const PointSet points = roomWithCan();
  VolumetricOptions options = withMap(7, FreeSpaceMap(Sets({besideTheCan()})));
  options.threads = 1;
  const TriangleMesh one = reconstructVolumetric(points, options).mesh;
  options.threads = 4;
  const TriangleMesh four = reconstructVolumetric(points, options).mesh;
  EXPECT_EQ(one.vertices, four.vertices);
  EXPECT_EQ(one.faces, four.faces);
}

TEST(FreeSpaceReconstruction, SeveralRanksRefuse)
{
  const PointSet points = roomWithCan();
  const VolumetricOptions options = withMap(6, FreeSpaceMap(Sets({besideTheCan()})));
  ThreadRanks::run(2, [&](Exchange& exchange) {
    EXPECT_THROW(
        reconstructVolumetricPart(std::make_unique<Sets>(std::vector<PointSet>{points}), options, {}, exchange),
        std::invalid_argument);
  });
}

TEST(FreeSpaceReconstruction, MovedInputGivesMovedOutput)
{
  PointSet points = roomWithCan(), beams = besideTheCan();
  const Index there = verticesInFreeSpace(reconstructVolumetric(points, withMap(7, FreeSpaceMap(Sets({beams})))),
                                          points, FreeSpaceMap(Sets({beams})));
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  points = transformPoints(points, T);
  beams = transformPoints(beams, T);
  points.origin = beams.origin = {1e6, -2e6, 300};
  const FreeSpaceMap map(Sets({beams}));
  const VolumetricResult plain = reconstructVolumetric(points, atDepth(7)),
                         result = reconstructVolumetric(points, withMap(7, map));
  EXPECT_EQ(result.mesh.origin, points.origin);
  EXPECT_LT(verticesInFreeSpace(result, points, map), verticesInFreeSpace(plain, points, map) / 3);
  EXPECT_NEAR(verticesInFreeSpace(result, points, map), there, 30);
}
} // namespace
} // namespace fresco::test
