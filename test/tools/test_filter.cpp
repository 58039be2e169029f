// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cloud_tool.h"
#include <fresco/filters/core/mixed_pixels.h>
namespace fresco {
namespace {
using namespace test;

struct Filter : CloudTool {
  Filter() : CloudTool("filter") {}
};

TEST_F(Filter, KeepsEveryFieldOfThePointsThatStay)
{
  const std::string in = scanFile("scan.pcd");
  ASSERT_EQ(run(in + " " + path("result.pcd") + " -veil 15"), 0) << errors();
  const PointSet before = readPoints(in), after = readPoints(path("result.pcd"));
  MixedPixelOptions options;
  options.angle = 15;
  const PointSet truth = selectPoints(before, withoutMixedPixels(before.points, before.viewpoints, options));
  EXPECT_TRUE(test::same(after.points, truth.points));
  EXPECT_TRUE((after.colors.array() == truth.colors.array()).all());
  EXPECT_TRUE(test::same(after.intensities, truth.intensities));
  EXPECT_EQ(fieldNames(readCloud(path("result.pcd"))), fieldNames(readCloud(in)));
  ASSERT_EQ(run(in + " " + path("removed.pcd") + " -removed -veil 15"), 0);
  EXPECT_EQ(readPoints(path("removed.pcd")).size() + after.size() + 1, before.size());
}

TEST_F(Filter, StepsAndThreads)
{
  const std::string in = scanFile("scan.pcd"),
                    options = " -veil 15 -scattered 12 -outliers 12 3 -relative -voxel 0.05 -centroid -quiet ";
  ASSERT_EQ(run(in + " " + path("one.pcd") + options + "-threads 1"), 0) << errors();
  ASSERT_EQ(run(in + " " + path("four.pcd") + options + "-threads 4"), 0) << errors();
  EXPECT_EQ(readFile(path("one.pcd")), readFile(path("four.pcd")));
  EXPECT_EQ(errors(), "");
  ASSERT_EQ(run(in + " " + path("plain.ply")), 0) << errors();
  EXPECT_EQ(readPoints(path("plain.ply")).size() + 1, readPoints(in).size());
}

TEST_F(Filter, KeepsOrganizedClouds)
{
  CloudFile file = readCloud(scanFile("scan.pcd"));
  file.cloud.height = 2;
  file.cloud.width /= 2;
  file.cloud.data.resize(std::size_t{2} * file.cloud.width * file.cloud.point_step);
  file.cloud.row_step = file.cloud.width * file.cloud.point_step;
  writeCloud(path("grid.pcd"), file);
  ASSERT_EQ(run(path("grid.pcd") + " " + path("kept.pcd") + " -veil 15 -keep_organized"), 0) << errors();
  const CloudFile kept = readCloud(path("kept.pcd"));
  EXPECT_EQ(kept.cloud.height, 2u);
  EXPECT_EQ(kept.cloud.width, file.cloud.width);
  EXPECT_FALSE(kept.cloud.is_dense);
}

TEST_F(Filter, HelpNamesEveryOption) { expectInHelp({"-outliers K SIGMA", "-scattered N", "-veil", "-voxel"}); }

TEST_F(Filter, BadInputEndsWithOneLineAndNoFile)
{
  const std::string good = scanFile("scan.pcd"), out = " " + path("result.pcd");
  expectCommonFailures(good);
  for (const std::string options :
       {"-outliers 0 1", "-outliers 5", "-scattered 1", "-veil 90", "-veil x", "-voxel 0", "-voxel -1", "-noise -1"})
    expectFailure(good + out + " " + options, 2);
  expectFailure(good + out + " -voxel 1e-9", 1);
  expectFailure(text("points.xyz", "0 0 0\n1 1 1\n") + out + " -veil 10", 1);
}

TEST_F(Filter, SmallCloudsPass)
{
  for (const char* const points : few_points) {
    const std::string in = text("few.xyz", points);
    EXPECT_EQ(run(in + " " + path("few.pcd") + " -viewpoint 0 0 9 -veil 10 -scattered 8 -outliers 8 2"), 0) << errors();
    EXPECT_EQ(readPoints(path("few.pcd")).points, readPoints(in).points) << "too few to tell what is alone";
  }
}

TEST_F(Filter, RealScan)
{
  FRESCO_NEED_DATA("apartment/cloud.00000.vtk");
  const std::string apartment = test::dataFolder() + "/apartment/cloud.00000.vtk";
  ASSERT_EQ(run(apartment + " " + path("a.pcd") + " -viewpoint 0 0 0 -veil 15 -outliers 16 3 -relative"), 0)
      << errors();
  const double share =
      static_cast<double>(readPoints(path("a.pcd")).size()) / static_cast<double>(readPoints(apartment).size());
  EXPECT_GT(share, 0.9);
  EXPECT_LT(share, 1.0);
}
} // namespace
} // namespace fresco
