// SPDX-License-Identifier: BSD-3-Clause
#include "registration/registration_scene.h"
#include "scan/scan_free_space.h"
#include <algorithm>
#include <gtest/gtest.h>
namespace fresco::registration {
namespace {
using Verdict = ScanFreeSpace::Verdict;

// All around, by Fibonacci's lattice.
Points directions(Index n)
{
  Points sphere(3, n);
  for (Index i = 0; i < n; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / n, angle = i * M_PI * (3.0 - std::sqrt(5.0)), r = std::sqrt(1.0 - z * z);
    sphere.col(i) = Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), z).cast<float>();
  }
  return sphere;
}

// A cell of directions may be bounded by its neighbours' rays alone: then nobody looked there.
TEST(ScanFreeSpace, OnlyOwnRaysContradictWhereAskedFor)
{
  const Points sphere = 5.f * directions(6000);
  std::vector<Index> kept;
  for (Index i = 0; i < sphere.cols(); ++i) {
    if (!(std::abs(sphere(1, i)) < 0.3f && sphere(0, i) > 0.f)) // nothing came back from a band a cell wide
      kept.push_back(i);
  }
  const ScanFreeSpace space(sphere(Eigen::all, kept), Points::Zero(3, 1), 0.1f);
  Points points(3, 2);
  points << 2.f, -2.f, 0.f, 0.f, 0.1f, 0.1f;
  const auto judge = [&](bool own_rays) {
    return space.judge({points}, Eigen::Isometry3f::Identity(), {0.2f, 0.02f, own_rays});
  };
  EXPECT_EQ(judge(false), (std::vector<Verdict>{Verdict::violates, Verdict::violates}));
  EXPECT_EQ(judge(true), (std::vector<Verdict>{Verdict::unknown, Verdict::violates}));
}

// What a scanner at the origin sees of a corridor of 30 x 3 m. From its floor, 1.6 m below, nothing comes back beyond 6 m.
Points scanOfCorridor()
{
  const Eigen::Array3f high(15.f, 1.5f, 1.2f), low(-15.f, -1.5f, -1.6f);
  const Points rays = directions(20000);
  Points hits(3, rays.cols());
  Index count = 0;
  for (Index i = 0; i < rays.cols(); ++i) {
    const Eigen::Array3f ray = rays.col(i);
    const Eigen::Array3f ranges = (ray > 0.f).select(high / ray, low / ray);
    Index axis = 0;
    const float range = ranges.minCoeff(&axis);
    if (!(axis == 2 && ray.z() < 0.f && range > 6.f))
      hits.col(count++) = (range * ray).matrix();
  }
  return hits.leftCols(count);
}

// Points of a strip along the corridor.
Points strip(float x, float length, float z)
{
  Points points(3, 200);
  for (Index i = 0; i < points.cols(); ++i)
    points.col(i) << x + length * static_cast<float>(i) / 200.f, 0.1f * static_cast<float>(i % 5), z;
  return points;
}

TEST(ScanFreeSpace, GrazedSurfacesContradictOnlyWhereRaysPassedThroughThem)
{
  const ScanFreeSpace space(scanOfCorridor(), Points::Zero(3, 1), 0.1f);
  const ScanFreeSpace::Slack slack{0.2f, 0.02f, false};
  const auto violating = [&](const Points& points, const Eigen::Vector3f& normal, bool grazed) {
    const Points normals = normal.replicate(1, points.cols());
    const auto count = [&](const Points* given) {
      const std::vector<Verdict> verdicts = space.judge({points, given}, Eigen::Isometry3f::Identity(), slack);
      return static_cast<Index>(std::count(verdicts.begin(), verdicts.end(), Verdict::violates));
    };
    return grazed ? count(nullptr) - count(&normals) : count(&normals);
  };
  const Eigen::Vector3f up(0, 0, 1), along(1, 0, 0), unknown(0, 0, 0);
  const Points floor = strip(9.f, 4.f, -1.6f); // the end of the corridor fills its directions
  EXPECT_GT(violating(floor, up, true), 20);
  EXPECT_EQ(violating(floor, up, false), 0);
  // What stands upright there would have been seen. So would a table be: rays of the same cells go far below its top.
  EXPECT_EQ(violating(floor, along, true), 0);
  EXPECT_EQ(violating(floor, unknown, true), 0);
  const Points table = strip(4.f, 2.f, -0.3f);
  EXPECT_EQ(violating(table, up, true), 0);
  EXPECT_EQ(violating(table, up, false), table.cols());
}

// What is said of many points does not depend on looking at blocks of them first.
TEST(ScanFreeSpace, BlocksChangeNoVerdict)
{
  const test::ScannedScene scene = test::scanTwoRooms(20000);
  std::mt19937 random(7);
  const auto uniform = [&](double most) { return most * (2.0 * (random() / 4294967296.0) - 1.0); };
  for (const PointSet& seer : scene.scans) {
    ScanFreeSpace space(seer.points, Points::Zero(3, 1), 0.1f);
    space.prepareManyJudgements();
    const Points& points = scene.scans.back().points;
    const PointBlocks blocks(points);
    for (int k = 0; k < 40; ++k) {
      const Eigen::Vector3d shift(uniform(8.0), uniform(8.0), uniform(1.0));
      const Eigen::Isometry3d T =
          Eigen::Translation3d(shift) * Eigen::AngleAxisd(uniform(3.0), Eigen::Vector3d::UnitZ());
      const ScanFreeSpace::Slack slack{0.2f, 0.02f};
      EXPECT_EQ(space.judge({points, nullptr, &blocks}, T.cast<float>(), slack),
                space.judge({points}, T.cast<float>(), slack))
          << k;
    }
  }
}

TEST(PointBlocks, EachPointIsInOneAndWithinItsSphere)
{
  const Points points = test::scanTwoRooms(5000).scans.front().points;
  std::vector<int> visits(points.cols(), 0);
  Eigen::Vector3f center;
  float radius = 0.f;
  int spheres = 0;
  const auto keep = [&](const Eigen::Vector3f& middle, float reach) {
    center = middle;
    radius = reach;
    ++spheres;
    return spheres % 2 == 0; // every second one is left out
  };
  Index seen = 0;
  PointBlocks(points).visit(keep, [&](Index i) {
    ++visits[i];
    ++seen;
    EXPECT_LE((points.col(i) - center).norm(), radius);
  });
  EXPECT_LE(*std::max_element(visits.begin(), visits.end()), 1);
  EXPECT_NEAR(1.0 * seen / points.cols(), 0.5, 0.01);
  EXPECT_TRUE(PointBlocks().empty());
  EXPECT_TRUE(PointBlocks(Points(3, 0)).empty());
}

// No direction of a cone is seen farther than told, at corners of the cube as well; behind a wall that is all around little
// is told.
TEST(FarthestTiles, BoundWhatAConeHolds)
{
  for (const int side : {8, 21, 75}) {
    std::mt19937 random(side);
    std::vector<float> farthest(6 * side * side, 3.f);
    for (int k = 0; k < 20; ++k)
      farthest[random() % farthest.size()] = 4.f + k; // doors
    const FarthestTiles tiles(farthest, side);
    const Points axes = directions(2000), others = directions(12000);
    const float least_cosine = std::cos(FarthestTiles::widest);
    int near_walls = 0;
    for (Index i = 0; i < axes.cols(); ++i) {
      float most = 0.f;
      for (Index k = 0; k < others.cols(); ++k)
        if (axes.col(i).dot(others.col(k)) >= least_cosine)
          most = std::max(most, farthest[cubeCell(others.col(k), side)]);
      EXPECT_GE(tiles.around(axes.col(i)), most);
      near_walls += tiles.around(axes.col(i)) == 3.f ? 1 : 0;
    }
    EXPECT_GT(near_walls, axes.cols() / 4);
  }
}
} // namespace
} // namespace fresco::registration
