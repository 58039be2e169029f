// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tool_runs.h"
#include "tracking/rgbd_room.h"
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <gtest/gtest.h>
namespace fresco::test {
namespace {
constexpr int frames = 40;

/// A video whose numbers have no leading zeros, so that the order of names is not that of numbers.
std::string videoFolder()
{
  const std::string folder = scratchFolder();
  makeFolder(folder + "/video");
  put(folder + "/video/camera-intrinsics.txt", "140 0 79.5\n0 140 59.5\n0 0 1\n");
  const std::vector<RgbdImage> images = shootAll(swingPoses(frames));
  for (int f = 0; f < frames; ++f) {
    const std::string stem = folder + "/video/frame-" + std::to_string(f);
    writeImage(stem + ".color.jpg", images[f].color);
    writeImage(stem + ".depth.png", images[f].depth);
  }
  return folder;
}

TEST(ToolTrack, WritesAPoseAFrameInTheOrderOfTheNumbers)
{
  const std::string folder = videoFolder();
  const Outcome outcome = run(folder, "track video -o out");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("40 of 40 frames placed"), std::string::npos) << outcome.err;
  EXPECT_LT(worstError(readPoses(folder + "/out/poses.txt"), swingPoses(frames)), 0.02);
}

TEST(ToolTrack, DamagedFramesAreNamedAndTheOthersPlaced)
{
  const std::string folder = videoFolder();
  const std::string depth = folder + "/video/frame-7.depth.png";
  put(depth, get(depth).substr(0, 500));
  const Outcome outcome = run(folder, "track video -o out");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("frame-7.depth.png"), std::string::npos) << outcome.err;
  EXPECT_FALSE(readPoses(folder + "/out/poses.txt").at(7));
}

TEST(ToolTrack, BadFoldersAreOneLine)
{
  const std::string folder = videoFolder();
  expectRefused(folder, "track nothing -o out", "camera-intrinsics.txt");
  put(folder + "/file", "");
  expectRefused(folder, "track video -o file/out", "file/out");
  EXPECT_EQ(run(folder, "track video").status, 2);
  EXPECT_EQ(run(folder, "track video -o video").status, 2);
  EXPECT_EQ(run(folder, "track video -o out -rounds 11").status, 2);
  const Image16 other{80, 60, std::vector<std::uint16_t>(4800, 1500)};
  writeImage(folder + "/video/frame-9.depth.png", other);
  expectRefused(folder, "track video -o out", "two videos");
  fs::remove(folder + "/video/frame-3.color.jpg");
  expectRefused(folder, "track video -o out", "frame-3.color.jpg");
  fs::remove(folder + "/video/camera-intrinsics.txt");
  expectRefused(folder, "track video -o out", "camera-intrinsics.txt: no such file");
}
} // namespace
} // namespace fresco::test
