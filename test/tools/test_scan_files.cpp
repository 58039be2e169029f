// SPDX-License-Identifier: BSD-3-Clause
#include "common/io/e57_file.h"
#include "registration/registration_scene.h"
#include "tools/cloud_tool.h"
#include <fresco/io/pose_file.h>
#include <fresco/io/scan_file.h>
#include <nlohmann/json.hpp>
namespace fresco {
namespace {
test::e57::Scan scanOf(const std::string& name, const PointSet& points)
{
  test::e57::Scan scan{name, {}, static_cast<std::size_t>(points.size())};
  for (int axis = 0; axis < 3; ++axis) {
    test::e57::Field field{std::string("cartesian") + "XYZ"[axis]};
    field.single = true;
    for (Index i = 0; i < points.size(); ++i)
      field.reals.push_back(points.points(axis, i));
    scan.fields.push_back(field);
  }
  return scan;
}

class RegisterStations : public test::CloudTool {
protected:
  RegisterStations() : CloudTool("register") {}
};

TEST_F(RegisterStations, EachScanOfAFileIsPlacedAndAnEmptyOneIsNamed)
{
  const test::ScannedScene scene = test::scanTwoRooms(20000);
  std::vector<test::e57::Scan> scans = {scanOf("a", scene.scans[0]), scanOf("nothing", PointSet()),
                                        scanOf("b", scene.scans[1])};
  for (test::e57::Scan& scan : scans)
    scan.more = test::e57::poseXml(1, 0, 100, 0, 0); // all alike: not where they belong
  writeFile(path("all.e57"), test::e57::fileOf(scans));
  ASSERT_EQ(run(path("all.e57") + " -o " + path("all")), 0) << errors();
  EXPECT_NE(errors().find("all.e57 scan 2: only 0 finite points"), std::string::npos) << errors();
  const std::vector<Pose> poses = readPoses(path("all/poses.txt"));
  ASSERT_EQ(poses.size(), 3u);
  EXPECT_FALSE(poses[1]);
  const Eigen::Matrix4d found = poses[0]->inverse() * *poses[2];
  const Eigen::Matrix4d truth = (scene.truth[0].inverse() * scene.truth[1]).matrix();
  EXPECT_LT((found - truth).topRightCorner(3, 1).norm(), 0.01);
  const auto report = nlohmann::json::parse(readFile(path("all/registration.json")));
  EXPECT_EQ(report["scans"][2]["file"], path("all.e57") + " scan 3");
  EXPECT_EQ(run(path("all.e57") + " " + path("all.e57") + " -o " + path("no") + " -poses " + path("all.e57")), 1);
  EXPECT_NE(errors().find("3 poses for 6 scans"), std::string::npos) << errors();
}

class FilterStations : public test::CloudTool {
protected:
  FilterStations() : CloudTool("filter") {}
};

TEST_F(FilterStations, ReadsAllScansOrOne)
{
  const std::string header = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n";
  text("two.ptx", "2\n1\n" + header + "0 0 0 1\n1 2 3 0.5\n2 2 3 0.5\n1\n1\n" + header + "10 0 0 1\n5 6 7 1\n");
  ASSERT_EQ(run(path("two.ptx") + " " + path("all.pcd")), 0) << errors();
  EXPECT_EQ(readPoints(path("all.pcd")).size(), 3);
  EXPECT_EQ(readPoints(path("all.pcd")).points(0, 2), 15.f); // in the frame of the file
  ASSERT_EQ(run(path("two.ptx") + " " + path("one.pcd") + " -scan 2"), 0) << errors();
  ASSERT_EQ(readPoints(path("one.pcd")).size(), 1);
  EXPECT_EQ(readPoints(path("one.pcd")).points(0, 0), 5.f); // in its own
  expectFailure(path("two.ptx") + " " + path("result.pcd") + " -scan 3", 1);
  expectFailure(path("one.pcd") + " " + path("result.pcd") + " -scan 1", 1);
  expectFailure(path("two.ptx") + " " + path("result.pcd") + " -scan -1", 2);
  expectFailure(text("cut.ptx", "2\n1\n" + header + "0 0 0 1\n1.125 2.125 3.125 0.5\n") + " " + path("result.pcd"), 1);
  EXPECT_NE(errors().find("2 points announced, 1 there"), std::string::npos) << errors();
}
} // namespace
} // namespace fresco
