// SPDX-License-Identifier: BSD-3-Clause
#include "tools/small_room.h"
#include "tools/tool_runs.h"
namespace fresco::test {
namespace {
/// A small room with cameras of their own frame in room/own, and its scans as cloud.ply and grey.ply.
std::string ownFrameRoom()
{
  const std::string folder = scratchFolder();
  writeOwnFrameRoom(folder + "/room", folder + "/room/own");
  PointSet cloud = readPoints(folder + "/room/scans/scan_00.pcd");
  cloud.points.colwise() += Eigen::Vector3f(1.2f, 1.1f, 1.3f); // its station
  writePoints(folder + "/cloud.ply", cloud);
  cloud.colors.resize(3, 0);
  writePoints(folder + "/grey.ply", cloud);
  return folder;
}

TEST(Align, CamerasComeToWhereTheyWere)
{
  const std::string folder = ownFrameRoom();
  const Outcome outcome = run(folder, "align room/own cloud.ply aligned");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("scale 50"), std::string::npos) << outcome.err;
  const CameraSet truth = readColmap(folder + "/room/cameras"), found = readColmap(folder + "/aligned");
  ASSERT_EQ(found.views.size(), truth.views.size());
  for (std::size_t v = 0; v < truth.views.size(); ++v) {
    EXPECT_LT((found.views[v].center() - truth.views[v].center()).norm(), 0.01);
    EXPECT_TRUE(found.views[v].T_camera_world.linear().isApprox(truth.views[v].T_camera_world.linear(), 0.005));
  }
  const SparsePoints points = readColmapPoints(folder + "/aligned");
  EXPECT_EQ(points.size(), 2000u);
  EXPECT_EQ(points[7].track[0].view, 3);
  EXPECT_EQ(run(folder, "align aligned cloud.ply again").status, 0);
  const Outcome again = run(folder, "align aligned cloud.ply again");
  EXPECT_NE(again.err.find("already"), std::string::npos) << again.err;
}

TEST(Align, WhatCannotBeAlignedIsRefused)
{
  const std::string folder = ownFrameRoom();
  expectRefused(folder, "align room/own grey.ply out", "ambiguous"); // a box without colours
  expectRefused(folder, "align room/cameras cloud.ply out", "no sparse points");
  expectRefused(folder, "align room/own missing.ply out", "missing.ply");
  expectRefused(folder, "align nowhere cloud.ply out", "nowhere");
  EXPECT_EQ(run(folder, "align room/own cloud.ply room/own").status, 2);
  put(folder + "/file", "in the way");
  expectRefused(folder, "align room/own cloud.ply file/out", "file");
  const std::string list = get(folder + "/room/own/points3D.txt");
  for (const auto& [text, reason] :
       std::vector<std::pair<std::string, std::string>>{{"", "points3D.txt"},
                                                        {"1 nan 0 0 1 2 3 0.5 1 0\n", "line 1"},
                                                        {"1 0 0 0 1 2\n", "line 1"},
                                                        {"1 0 0 0 1 2 3 0.5 77 0\n", "image 77"},
                                                        {"1 0 0 0 1 2 3 0.5 1 999999\n", "feature 999999"},
                                                        {"1 0 0 0 1 2 3 0.5\n", "too few"}}) {
    put(folder + "/room/own/points3D.txt", text);
    expectRefused(folder, "align room/own cloud.ply out", reason);
  }
  put(folder + "/room/own/points3D.txt", list);
}
} // namespace
} // namespace fresco::test
