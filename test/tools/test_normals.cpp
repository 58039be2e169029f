// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cloud_tool.h"
#include <cstring>
#include <fresco/core/require.h>
#include <fresco/filters/core/oriented_normals.h>
namespace fresco {
namespace {
using namespace test;

struct Normals : CloudTool {
  Normals() : CloudTool("normals") {}
};

/// Named field of point `i`, as bytes.
std::string bytesOf(const CloudFile& file, const std::string& name, std::size_t i)
{
  for (const auto& field : file.cloud.fields)
    if (field.name == name)
      return {reinterpret_cast<const char*>(file.cloud.data.data()) + i * file.cloud.point_step + field.offset,
              name == "label"    ? 2u
              : name == "spread" ? 24u
                                 : 4u};
  return "none";
}

TEST_F(Normals, KeepFieldsInAnyOrder)
{
  const auto* types = "4 2 4 8 4 4 4 4";
  for (const char* const fields : {"vp_x label y spread x z vp_z vp_y", "x label y spread vp_y z vp_z vp_x"})
    for (const char* const type : {"F U F F F F F F", "F I F F F F F F"}) {
      std::string file = "VERSION .7\nFIELDS " + std::string(fields) + "\nSIZE " + types + "\nTYPE " + type +
                         "\nCOUNT 1 1 1 3 1 1 1 1\nWIDTH 12\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 12\n"
                         "DATA ascii\n";
      for (int i = 0; i < 12; ++i)
        file +=
            concat(0.1 * i, " ", 7 * i, " ", i % 3, " ", i, " ", -i, " 0.3 ", i / 3, " ", i * i, " 5 ", 7 - i, "\n");
      const std::string in = text("odd.pcd", file);
      ASSERT_EQ(run(in + " " + path("kept.pcd") + " -bilateral 1"), 0) << errors();
      const CloudFile before = readCloud(in), after = readCloud(path("kept.pcd"));
      auto names = fieldNames(before);
      for (std::size_t i = 0; i < 12; ++i)
        for (const std::string& name : names)
          EXPECT_EQ(bytesOf(after, name, i), bytesOf(before, name, i)) << name << " of " << i;
      for (const char* const added : {"normal_x", "normal_y", "normal_z", "curvature"})
        names.emplace_back(added);
      EXPECT_EQ(fieldNames(after), names);
    }
}

TEST_F(Normals, AreThoseOfTheCoreAndOtherFieldsStay)
{
  const std::string in = scanFile("scan.pcd");
  ASSERT_EQ(run(in + " " + path("result.pcd") + " -k 12 -confidence"), 0) << errors();
  const PointSet before = readPoints(in), after = readPoints(path("result.pcd"));
  NormalOptions options;
  options.k = 12;
  EXPECT_TRUE(test::same(after.normals, estimateNormals(before, options).normals));
  EXPECT_TRUE(test::same(after.points, before.points));
  EXPECT_TRUE(test::same(after.intensities, before.intensities));
  EXPECT_EQ(after.confidences.size(), before.size());
  // A second run overwrites; the fields stay the same.
  ASSERT_EQ(run(path("result.pcd") + " " + path("again.pcd") + " -k 12 -flip -threads 3"), 0) << errors();
  EXPECT_TRUE(test::same(readPoints(path("again.pcd")).normals, Points(-after.normals)));
  EXPECT_EQ(fieldNames(readCloud(path("again.pcd"))), fieldNames(readCloud(path("result.pcd"))));
}

TEST_F(Normals, TakeTheViewpointFromOptionFieldsHeaderOrNeighbors)
{
  PointSet set;
  set.points = test::flatSquare(500, 1).points;
  const auto signOf = [&](const std::string& file, const std::string& options) {
    EXPECT_EQ(run(path(file) + " " + path("result.ply") + options), 0) << errors();
    const PointSet result = readPoints(path("result.ply"));
    return result.normals.row(2).minCoeff() > 0.9f ? 1 : result.normals.row(2).maxCoeff() < -0.9f ? -1 : 0;
  };
  writePoints(path("none.ply"), set);
  EXPECT_NE(signOf("none.ply", ""), 0);
  EXPECT_EQ(signOf("none.ply", " -viewpoint 0 0 -1"), -1);
  set.viewpoints = Eigen::Vector3f(0, 0, -3);
  writePoints(path("header.pcd"), set);
  EXPECT_EQ(signOf("header.pcd", ""), -1);
  EXPECT_EQ(signOf("header.pcd", " -viewpoint 0 0 1"), 1);
  set.viewpoints = Points::Random(3, 500);
  set.viewpoints.row(2).setConstant(-3);
  writePoints(path("fields.pcd"), set);
  EXPECT_EQ(signOf("fields.pcd", ""), -1);
  EXPECT_EQ(signOf("fields.pcd", " -propagate"), 1);
}

TEST_F(Normals, SmoothAndMove)
{
  PointSet set;
  set.points = test::withNoise(test::flatSquare(3000, 1).points, 0.02f, 3);
  set.viewpoints = Eigen::Vector3f(0, 0, 3);
  writePoints(path("noisy.pcd"), set);
  const auto spread = [&](const std::string& options, bool heights) {
    EXPECT_EQ(run(path("noisy.pcd") + " " + path("result.pcd") + options), 0) << errors();
    const PointSet result = readPoints(path("result.pcd"));
    return heights ? result.points.row(2).norm() : result.normals.topRows(2).norm();
  };
  EXPECT_LT(spread(" -bilateral 3 -sigma_n 30", false), 0.6f * spread("", false));
  EXPECT_LT(spread(" -bilateral 3 -sigma_d 0.2 -move 3", true), 0.6f * spread("", true));
}

TEST_F(Normals, HelpNamesEveryOption)
{
  expectInHelp({"-k", "-radius", "-viewpoint X Y Z", "-bilateral", "-sigma_d", "-sigma_n"});
}

TEST_F(Normals, BadInputEndsWithOneLineAndNoFile)
{
  const std::string good = scanFile("scan.pcd");
  expectCommonFailures(good);
  for (const std::string options : {"-k 2", "-k 5 -radius 1", "-radius 0", "-bilateral -1", "-sigma_n 0", "-sigma_d -1",
                                    "-viewpoint 0 0", "-propagate -viewpoint 0 0 1"})
    expectFailure(good + " " + path("result.pcd") + " " + options, 2);
}

TEST_F(Normals, SmallCloudsPass)
{
  for (const char* const points : few_points) {
    const std::string in = text("few.xyz", points);
    for (const std::string options : {" -bilateral 2", " -viewpoint 0 0 9 -radius 0.5 -bilateral 2 -move 1"}) {
      EXPECT_EQ(run(in + " " + path("few.pcd") + options), 0) << errors();
      const PointSet result = readPoints(path("few.pcd"));
      EXPECT_EQ(result.points, readPoints(in).points) << "a plane does not move";
      ASSERT_EQ(result.normals.cols(), result.size());
      for (Index i = 0; i < result.size(); ++i) {
        const Eigen::Vector3f n = result.normals.col(i), to_viewpoint = Eigen::Vector3f(0, 0, 9) - result.points.col(i);
        if (options.find("viewpoint") == std::string::npos) {
          EXPECT_EQ(n.norm() > 0, points == few_points[2]) << "three points alone tell a direction: " << points;
        } else if (to_viewpoint.norm() < 10) { // and not 1e30
          EXPECT_GT(n.dot(to_viewpoint.normalized()), 0.9f) << points;
        }
      }
    }
  }
}

TEST_F(Normals, RealScan)
{
  FRESCO_NEED_DATA("lobby/room_scan1.pcd");
  const std::string lobby = test::dataFolder() + "/lobby/room_scan1.pcd";
  ASSERT_EQ(run(lobby + " " + path("l.pcd") + " -bilateral 2"), 0) << errors();
  const PointSet set = readPoints(path("l.pcd"));
  Index towards = 0;
  for (Index i = 0; i < set.size(); ++i)
    towards += set.normals.col(i).dot(-set.points.col(i)) >= 0;
  EXPECT_GT(static_cast<double>(towards), 0.99 * static_cast<double>(set.size()));
}
} // namespace
} // namespace fresco
