// SPDX-License-Identifier: BSD-3-Clause
#include "registration/registration_scene.h"
#include "test_data.h"
#include <cstdlib>
#include <fresco/io/file.h>
#include <fresco/io/point_io.h>
#include <fresco/io/pose_file.h>
#include <fresco/io/scan_file.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
namespace fresco {
namespace {
int run(const std::string& arguments)
{
  const std::string command =
      test::buildFolder() + "/bin/fresco_register " + arguments + " >/dev/null 2>" + test::scratchFolder() + ".err";
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

// The good ones among them are placed, and what is wrong with the others is said on the terminal and in the report.
TEST(RegisterTool, BrokenFilesAmongGoodOnesAreWarnings)
{
  const std::string folder = test::scratchFolder() + "_data";
  makeFolder(folder + "/scans");
  const auto scene = test::scanTwoRooms(20000);
  for (const char* name : {"a", "c", "d"})
    writePoints(folder + "/scans/" + name + ".pcd", scene.scans[*name == 'a' ? 0 : 1]); // c and d are one scan
  writeFile(folder + "/scans/b.pcd", "");
  writeFile(folder + "/scans/e.e57", "no E57 file");
  ASSERT_EQ(run(folder + "/scans -o " + folder + "/out"), 0) << message();
  const auto poses = readPoses(folder + "/out/poses.txt");
  ASSERT_EQ(poses.size(), 5u);
  EXPECT_TRUE(poses[0] && poses[2] && poses[3]);
  EXPECT_FALSE(poses[1] || poses[4]);
  for (const std::string& text : {message(), readFile(folder + "/out/registration.json")})
    for (const char* part : {"b.pcd: left out", "e.e57: left out", "d.pcd: the same points as"})
      EXPECT_NE(text.find(part), std::string::npos) << part;
  EXPECT_EQ(run(folder + "/scans/b.pcd " + folder + "/scans/e.e57 -o " + folder + "/none"), 1);
  EXPECT_FALSE(std::filesystem::exists(folder + "/none"));
}

TEST(RegisterTool, FixedPosesAreWrittenAsTheyWereRead)
{
  const std::string folder = test::scratchFolder() + "_data";
  makeFolder(folder);
  const auto scene = test::scanTwoRooms(20000);
  std::string scans;
  for (std::size_t i = 0; i < 3; ++i) {
    writePoints(folder + "/scan_" + std::to_string(i) + ".pcd", scene.scans[i]);
    scans += folder + "/scan_" + std::to_string(i) + ".pcd ";
  }
  const std::vector<Pose> start = {scene.truth[0].matrix(), Pose(), scene.truth[2].matrix()};
  writePoses(folder + "/start.txt", start);
  ASSERT_EQ(run(scans + "-o " + folder + "/out -poses " + folder + "/start.txt -fixed"), 0) << message();
  const auto poses = readPoses(folder + "/out/poses.txt"), given = readPoses(folder + "/start.txt");
  EXPECT_EQ(*poses[0], *given[0]);
  EXPECT_EQ(*poses[2], *given[2]);
  ASSERT_TRUE(poses[1].has_value());
  EXPECT_LT(test::relativeError(poses, scene).translation, 0.01);
  const auto report = nlohmann::json::parse(readFile(folder + "/out/registration.json"));
  for (const auto& pair : report["pairs"]) {
    EXPECT_TRUE(pair["a"] == 1 || pair["b"] == 1);
    EXPECT_EQ(pair["pose"].size(), 4u);
    EXPECT_EQ(pair["information"].size(), 6u);
  }
  EXPECT_EQ(run(scans + "-o " + folder + "/out -fixed"), 2);
}

// Two equal rooms: not all scans get a place, until a person tells where one is. What was found of pairs is used again.
TEST(RegisterTool, HintsAreFollowedAndPairsAreNotSearchedAgain)
{
  const std::string folder = test::scratchFolder() + "_data";
  makeFolder(folder + "/scans");
  const auto scene = test::scanTwinRooms(false, 15000);
  for (std::size_t i = 0; i < scene.scans.size(); ++i)
    writePoints(folder + "/scans/scan_" + std::to_string(i) + ".pcd", scene.scans[i]);
  ASSERT_EQ(run(folder + "/scans -o " + folder + "/out"), 0) << message();
  const auto report = nlohmann::json::parse(readFile(folder + "/out/registration.json"));
  ASSERT_FALSE(report["unplaced"].empty());
  std::string hints;
  for (std::size_t i = 0; i < scene.scans.size(); ++i) {
    if (report["scans"][i]["placed"]) {
      continue;
    }
    EXPECT_NE(report["scans"][i]["refusal"]["reason"], "none");
    const std::size_t placed = report["scans"][0]["placed"] ? 0 : 2;
    const Eigen::Isometry3d T = scene.truth[placed].inverse() * scene.truth[i];
    hints += "relative scan_" + std::to_string(placed) + " scan_" + std::to_string(i);
    for (int k = 0; k < 12; ++k)
      hints += " " + std::to_string(T(k / 4, k % 4));
    hints += "\n";
  }
  writeFile(folder + "/hints.txt", hints);
  for (const char* out : {"/out -resume", "/scratch"})
    ASSERT_EQ(run(folder + "/scans -hints " + folder + "/hints.txt -o " + folder + out), 0) << message();
  for (const char* name : {"poses.txt", "registered.pcd", "registration.json", "registration.html"})
    EXPECT_EQ(readFile(folder + "/out/" + name), readFile(folder + "/scratch/" + name)) << name;
  const auto poses = readPoses(folder + "/out/poses.txt");
  EXPECT_EQ(std::count(poses.begin(), poses.end(), std::nullopt), 0);
  EXPECT_LT(test::relativeError(poses, scene).translation, 0.02);
  EXPECT_NE(message().find("hints.txt: line 1: "), std::string::npos);
  writeFile(folder + "/hints.txt", "link scan_0 scam_1\n");
  EXPECT_EQ(run(folder + "/scans -o " + folder + "/none -hints " + folder + "/hints.txt"), 1);
  EXPECT_NE(message().find("hints.txt: line 1: no scan is called scam_1; there are scan_1.pcd"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder + "/none"));
}

// What comes out as .e57 is where the poses and the given frame say.
TEST(RegisterTool, PlacedScansAreWrittenInTheFrameOfTheWorld)
{
  const std::string folder = test::scratchFolder() + "_data";
  makeFolder(folder);
  const auto scene = test::scanTwoRooms(5000);
  writePoints(folder + "/a.ply", scene.scans[0]);
  writePoints(folder + "/b.ply", scene.scans[1]);
  writePoses(folder + "/start.txt", {scene.truth[0].matrix(), scene.truth[1].matrix()});
  const Eigen::Isometry3d T_world(Eigen::Translation3d(4e5, 5e6, 100) * Eigen::AngleAxisd(1, Eigen::Vector3d::UnitZ()));
  writePoses(folder + "/world.txt", {T_world.matrix()});
  const std::string words = folder + "/a.ply " + folder + "/b.ply -fixed -poses " + folder + "/start.txt -o " + folder;
  ASSERT_EQ(run(words + "/out -e57 " + folder + "/all.e57 -to_world " + folder + "/world.txt"), 0) << message();
  const std::vector<ScanInfo> scans = readScanInfos(folder + "/all.e57");
  ASSERT_EQ(scans.size(), 2u);
  for (int i = 0; i < 2; ++i) {
    const Eigen::Isometry3d expected = T_world * scene.truth[i];
    EXPECT_LT((scans[i].T_file_scan.matrix() - expected.matrix()).cwiseAbs().maxCoeff(), 1e-8);
  }
  EXPECT_EQ(readPoints(folder + "/all.e57").size(), scene.scans[0].size() + scene.scans[1].size());
  EXPECT_EQ(run(words + "/none -to_world " + folder + "/world.txt"), 2);
  EXPECT_EQ(run(words + "/none -e57 " + folder + "/all.las"), 2);
  EXPECT_EQ(run(words + "/none -e57 " + folder + "/a.e57 -to_world " + folder + "/a.ply"), 1);
  EXPECT_FALSE(std::filesystem::exists(folder + "/a.e57"));
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
