// SPDX-License-Identifier: BSD-3-Clause
#include "registration/registration_scene.h"
#include "test_data.h"
#include <cstdlib>
#include <fresco/io/file.h>
#include <fresco/io/point_io.h>
#include <fresco/io/pose_file.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
namespace fresco {
namespace {
int run(const std::string& arguments)
{
  const std::string command = std::string(FRESCO_BINARY_DIR) + "/bin/fresco_register " + arguments + " >/dev/null 2>" +
                              test::scratchFolder() + ".err";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string message() { return readFile(test::scratchFolder() + ".err"); }

TEST(RegisterTool, WritesPosesCloudAndReport)
{
  const std::string folder = test::scratchFolder() + "_data";
  makeFolder(folder);
  const auto scene = test::scanTwoRooms(30000);
  for (std::size_t i = 0; i < 3; ++i)
    writePoints(folder + "/scan_" + std::to_string(i) + ".pcd", scene.scans[i]);
  ASSERT_EQ(run(folder + " -o " + folder + "/out -quiet"), 0) << message();
  const auto poses = readPoses(folder + "/out/poses.txt");
  ASSERT_EQ(poses.size(), 3u);
  EXPECT_LT(test::relativeError(poses, scene).translation, 0.01);
  const PointSet merged = readPoints(folder + "/out/registered.pcd");
  EXPECT_EQ(merged.size(), scene.scans[0].size() + scene.scans[1].size() + scene.scans[2].size());
  EXPECT_TRUE(merged.hasNormals());
  EXPECT_EQ(merged.viewpoints.cols(), merged.size());
  const auto report = nlohmann::json::parse(readFile(folder + "/out/registration.json"));
  EXPECT_EQ(report["scans"].size(), 3u);
  EXPECT_TRUE(report["unplaced"].empty());
  EXPECT_EQ(report["pairs"].size(), 3u);
  ASSERT_EQ(run(folder + "/scan_0.pcd " + folder + "/scan_1.pcd " + folder + "/scan_2.pcd -o " + folder +
                "/again -poses " + folder + "/out/poses.txt -quiet"),
            0);
  EXPECT_LT(test::relativeError(readPoses(folder + "/again/poses.txt"), scene).translation, 0.01);
}

TEST(RegisterTool, WrongUseAndBadInput)
{
  const std::string folder = test::scratchFolder() + "_data";
  makeFolder(folder);
  const auto scene = test::scanTwoRooms(3000);
  writePoints(folder + "/scan.pcd", scene.scans[0]);
  EXPECT_EQ(run(folder + "/scan.pcd"), 2);
  EXPECT_EQ(run("-o " + folder), 2);
  EXPECT_EQ(run(folder + "/scan.pcd -o " + folder + "/out -nonsense"), 2);
  EXPECT_EQ(run(folder + "/scan.pcd -o " + folder + "/out -voxel -1"), 2);
  EXPECT_EQ(run(folder + "/missing.pcd -o " + folder + "/out"), 1);
  EXPECT_EQ(run(folder + "/scan.pcd -o " + folder + "/out -poses " + folder + "/missing.txt"), 1);
  EXPECT_EQ(run(folder + "/scan.pcd -o " + folder + "/scan.pcd/out"), 1);
  EXPECT_EQ(run(folder + "/scan.pcd -o " + folder + "/out -quiet"), 0);
  for (const auto& entry : std::filesystem::directory_iterator(folder + "/out"))
    EXPECT_NE(entry.path().filename().string()[0], '.') << entry.path();
}
} // namespace
} // namespace fresco
