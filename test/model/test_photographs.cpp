// SPDX-License-Identifier: BSD-3-Clause
#include "blots.h"
#include "input/model_input.h"
#include "photographs/program.h"
#include "photographs/structure_from_motion.h"
#include "stages/video.h"
#include "test_data.h"
#include "tools/small_room.h"
#include <chrono>
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/model/build_model.h>
#include <fstream>
#include <iomanip>
#include <map>
namespace fresco::model {
namespace {
namespace fs = std::filesystem;
using Lines = std::vector<std::string>;

Lines linesOf(const Lines& command, const std::string& log)
{
  Lines lines;
  runProgram(
      command, log, [&](const std::string& line) { lines.push_back(line); }, [] {});
  return lines;
}

TEST(Program, WordsReachItAsTheyAreAndLinesAreHeard)
{
  const std::string log = test::scratchFolder() + "/log.txt", word = "two words' \"and\" $HOME; *";
  EXPECT_EQ(linesOf({"/usr/bin/printf", "%s\\n%s", word, "last"}, log), (Lines{word, "last"}));
  EXPECT_EQ(readFile(log), word + "\nlast\n");
}

TEST(Program, FailureTellsTheLastLines)
{
  const std::string log = test::scratchFolder() + "/log.txt";
  try {
    linesOf({"/bin/sh", "-c", "echo far; echo b; echo c; echo it broke >&2; exit 3"}, log);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("ended with 3"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("it broke"), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find("far"), std::string::npos) << error.what();
  }
  EXPECT_THROW(linesOf({"/nowhere/program"}, log), std::runtime_error);
  EXPECT_THROW(linesOf({"/bin/sh", "-c", "kill -9 $$"}, log), std::runtime_error);
}

TEST(Program, StoppingKillsItAndWhatItStarted)
{
  const std::string folder = test::scratchFolder();
  const auto start = std::chrono::steady_clock::now();
  int asked = 0;
  const auto stop = [&] {
    if (++asked > 3)
      throw Cancelled();
  };
  EXPECT_THROW(runProgram(
                   {"/bin/sh", "-c", "(sleep 2; echo alive > '" + folder + "/child') & sleep 60"}, folder + "/log.txt",
                   [](const std::string&) {}, stop),
               Cancelled);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
  EXPECT_TRUE(findProgram("no such program").empty());
  EXPECT_EQ(linesOf({"/bin/sleep", "2.5"}, folder + "/log.txt"), Lines{});
  EXPECT_FALSE(std::filesystem::exists(folder + "/child"));
}

TEST(Program, EndsWithItselfThoughAnotherKeepsItsOutput)
{
  const std::string folder = test::scratchFolder();
  for (const std::string keeper : {"", "setsid "}) {
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(linesOf({"/bin/sh", "-c", keeper + "sleep 20 & echo done"}, folder + "/log.txt"), Lines{"done"});
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
  }
  linesOf({"/bin/sh", "-c", "(sleep 2; echo alive > '" + folder + "/left') &"}, folder + "/log.txt");
  EXPECT_EQ(linesOf({"/bin/sh", "-c", "exec >&- 2>&-; sleep 2.5"}, folder + "/log.txt"), Lines{})
      << "and stays without an output";
  EXPECT_FALSE(std::filesystem::exists(folder + "/left"));
}

TEST(Program, LineWithoutAnEndComesInPieces)
{
  const std::string log = test::scratchFolder() + "/log.txt";
  std::size_t bytes = 0, longest = 0;
  for (const std::string& line : linesOf({"/usr/bin/head", "-c", "20000000", "/dev/zero"}, log)) {
    bytes += line.size();
    longest = std::max(longest, line.size());
  }
  EXPECT_EQ(bytes, 20000000u);
  EXPECT_LT(longest, 100000u);
}

TEST(StructureFromMotion, ProgressIsReadFromTheLines)
{
  EXPECT_DOUBLE_EQ(shareToldBy("Processed file [3/12]", 12), 0.25);
  EXPECT_DOUBLE_EQ(shareToldBy("Matching block [2/2, 1/2] in 3.2s", 100), 0.5);
  EXPECT_DOUBLE_EQ(shareToldBy("Registering image #7 (5)", 10), 0.5);
  EXPECT_DOUBLE_EQ(shareToldBy("  => Image sees 12 / 34 points", 10), -1);
}

TEST(StructureFromMotion, WithoutTheProgramThePackageIsNamed)
{
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  try {
    requireStructureFromMotion("images", 2);
    ADD_FAILURE();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("package colmap"), std::string::npos) << error.what();
  }
  setenv("PATH", path.c_str(), 1);
  EXPECT_THROW(requireStructureFromMotion("images", 1), std::runtime_error); // with and without it
}

/// What is said if `colmap` is a script that says a line and fails.
std::string failureOf(const std::string& line)
{
  const std::string folder = test::scratchFolder(), path = std::getenv("PATH");
  writeFile(folder + "/colmap", "#!/bin/sh\necho '" + line + "'\nexit 1\n");
  std::filesystem::permissions(folder + "/colmap", std::filesystem::perms::owner_all);
  setenv("PATH", folder.c_str(), 1);
  std::string said;
  try {
    StructureFromMotion(folder, {"a.png", "b.png"}, folder + "/work", 1).findCameras({});
  } catch (const std::runtime_error& error) {
    said = error.what();
  }
  setenv("PATH", path.c_str(), 1);
  return said;
}

TEST(StructureFromMotion, NothingPlacedIsSaidInOneLine)
{
  EXPECT_NE(failureOf("ERROR: failed to create sparse model").find("could place none of the 2 photographs"),
            std::string::npos);
  EXPECT_NE(failureOf("ERROR: database is locked").find("database is locked"), std::string::npos);
}

TEST(StructureFromMotion, PhotographsOfOneKindShareACamera)
{
  const std::string folder = test::scratchFolder();
  writeImage(folder + "/a.jpg", Image(40, 30));
  writeImage(folder + "/b.png", Image(40, 30));
  writeImage(folder + "/c.png", Image(30, 40));
  EXPECT_TRUE(isOneCamera(folder, {"a.jpg", "b.png"}, 2));
  EXPECT_FALSE(isOneCamera(folder, {"a.jpg", "b.png", "c.png"}, 2));
  std::string bytes = readFile(folder + "/a.jpg");
  bytes.insert(2, std::string("\xFF\xE1\0\x08"
                              "Exif\0\0",
                              10));
  writeFile(folder + "/a.jpg", bytes);
  EXPECT_FALSE(isOneCamera(folder, {"a.jpg", "b.png"}, 2)); // it tells what took it
}

TEST(ModelInput, ImagesWithoutCamerasAreToBePlaced)
{
  const std::string folder = test::scratchFolder();
  test::writeSmallRoom(folder, 500);
  std::filesystem::remove_all(folder + "/cameras");
  const ModelInput input = readModelInput(folder);
  EXPECT_EQ(input.unplaced, (Lines{"view_0.png", "view_1.png", "view_2.png", "view_3.png"}));
  EXPECT_TRUE(input.alignsCameras());
  EXPECT_EQ(describe(input), "2 scans, 4 photographs without cameras");
}

Image blotted(const CameraModel& camera, const Eigen::Isometry3d& T_camera_world)
{
  Image image = test::photographRoom(camera, T_camera_world);
  const Eigen::Isometry3d T_world_camera = T_camera_world.inverse();
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector3d at = test::wallPoint(T_world_camera.translation(),
                                                 T_world_camera.linear() * unproject(camera, {x + 0.5, y + 0.5}));
      std::fill_n(image.pixel(x, y), 3, test::blotted(at));
    }
  return image;
}

/// A film in which one frame of each half second is sharp, and the others of it smeared.
TEST(Video, TheSharpestFrameOfEachWindowIsKept)
{
  if (findProgram("ffmpeg").empty()) {
    std::cout << "*** SKIPPED: the program ffmpeg is not installed ***\n";
    GTEST_SKIP();
  }
  constexpr int windows = 4, frames = 5; // of half a second, at ten a second
  const std::string folder = test::scratchFolder();
  makeFolder(folder + "/work");
  for (int f = 0; f < windows * frames; ++f) {
    const int window = f / frames, smear = f % frames == window ? 1 : 12; // pixels
    Image image(320, 240);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        for (int k = 0; k < 3; ++k)
          image.pixel(x, y)[k] =
              test::blotted({0.005 * (x / smear * smear), 0.005 * (y / smear * smear), 0.1 * window});
    for (int pass = 0; pass < (smear > 1 ? 20 : 0); ++pass) // no edges of blocks
      for (int y = 0; y + 1 < image.height; ++y)
        for (int x = 0; x + 1 < image.width; ++x)
          for (int k = 0; k < 3; ++k)
            image.pixel(x, y)[k] = (image.pixel(x, y)[k] + image.pixel(x + 1, y)[k] + 2 * image.pixel(x, y + 1)[k]) / 4;
    writeImage(folder + "/" + std::to_string(100 + f) + ".png", image);
  }
  const std::string video = folder + "/walk.avi";
  linesOf({findProgram("ffmpeg"), "-nostdin", "-framerate", "10", "-start_number", "100", "-i", folder + "/%d.png",
           "-c:v", "mjpeg", "-q:v", "2", video},
          folder + "/log.txt");
  EXPECT_NEAR(framesToKeep(video).count, windows, 2.0);
  EXPECT_EQ(framesToKeep(video).pixels, 320 * 240);
  ModelInput input;
  input.video = video;
  const ModelFiles files{folder};
  const auto figures = takeVideoFrames(input, files, 1, {});
  EXPECT_NEAR(figures["sharpest"].get<int>(), windows, 1);
  useVideoFrames(input, files.video);
  for (int w = 0; w < windows; ++w) // frame 0 of window 0, 1 of 1 ...
    EXPECT_TRUE(fs::exists(concat(files.video, "/", std::setfill('0'), std::setw(6), w * frames + w, ".jpg"))) << w;
  EXPECT_EQ(Index(input.unplaced.size()), figures["sharpest"].get<Index>());
}

/// What placing photographs is told to take, at least and at most.
TEST(StructureFromMotion, LargerAndMorePhotographsAreToldToTakeLonger)
{
  const std::string folder = test::scratchFolder();
  const auto told = [&](int count, int width) {
    const std::string name = concat(folder, "/", count, "_", width);
    makeFolder(name);
    for (int k = 0; k < count; ++k)
      writeImage(concat(name, "/", k, ".png"), Image(width, width));
    const ModelPlan plan = planModel({name, folder + "/out"});
    EXPECT_GE(plan.most_seconds, plan.seconds);
    return std::pair(plan.seconds, plan.most_seconds);
  };
  const auto few = told(4, 200), more = told(8, 200), larger = told(4, 400);
  for (const auto& longer : {more, larger}) {
    EXPECT_GT(longer.first, few.first);
    EXPECT_GT(longer.second, few.second);
  }
  for (std::size_t n = 2; n < 1000; ++n)
    EXPECT_LE(pairsToMatch(n), n * (n - 1) / 2) << n;
}

TEST(StructureFromMotion, PhotographsOfARoomArePlaced)
{
  if (findProgram("colmap").empty()) {
    std::cout << "*** SKIPPED: the program colmap is not installed ***\n";
    GTEST_SKIP();
  }
  const std::string folder = test::scratchFolder() + "/with space 'and quote";
  makeFolder(folder + "/images");
  CameraModel camera;
  camera.width = 480, camera.height = 360, camera.fx = camera.fy = 432, camera.cx = 240, camera.cy = 180;
  Lines names;
  std::map<std::string, Eigen::Isometry3d> truth; // by name
  for (int i = 0; i < 8; ++i) {
    Eigen::Matrix3d R;
    const double angle = 0.6 + 0.05 * i;
    R << std::sin(angle), -std::cos(angle), 0, 0, 0, -1, std::cos(angle), std::sin(angle), 0;
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = R;
    T.translation() = -R * Eigen::Vector3d(0.6 + 0.16 * i, 0.9 - 0.1 * (i % 3), 1.1 + 0.12 * (i % 2));
    names.push_back("photograph " + std::to_string(i) + ".png");
    truth[names.back()] = T;
    writeImage(folder + "/images/" + names.back(), blotted(camera, T));
  }
  const StructureFromMotion motion(folder + "/images", names, folder + "/work", 2);
  motion.findFeatures({});
  motion.matchFeatures({});
  EXPECT_EQ(motion.findCameras({}), Lines());
  const CameraSet found = readColmap(motion.model());
  ASSERT_EQ(found.views.size(), names.size());
  EXPECT_GT(readColmapPoints(motion.model()).size(), 100u);
  const auto turn = [](const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
    return Eigen::AngleAxisd(a.linear() * b.linear().transpose()).angle();
  };
  const auto way = [](const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
    return (a.inverse().translation() - b.inverse().translation()).norm();
  };
  const View &first = found.views.front(), &last = found.views.back();
  const double scale =
      way(last.T_camera_world, first.T_camera_world) / way(truth.at(last.image), truth.at(first.image));
  for (const View& view : found.views) { // a frame and a scale apart
    const Eigen::Isometry3d &a = truth.at(view.image), &b = truth.at(first.image);
    EXPECT_NEAR(turn(view.T_camera_world, first.T_camera_world), turn(a, b), 0.01) << view.image;
    EXPECT_NEAR(way(view.T_camera_world, first.T_camera_world), scale * way(a, b), 0.05 * scale) << view.image;
  }
}
} // namespace
} // namespace fresco::model
