// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "tools/small_room.h"
#include "tools/tool_runs.h"
#include <cerrno>
#include <fresco/core/constants.h>
#include <fresco/simulation/sensors/layout_files.h>
#include <fresco/simulation/sensors/layouts.h>
#include <fresco/simulation/sensors/survey.h>
namespace fresco::test {
/// RGB-D frames of the small room with their true poses, as fresco_scan -rgbd writes them: a walk around its middle.
inline void writeRgbdRoom(const std::string& folder, int frames)
{
  makeFolder(folder);
  const CameraModel camera{80, 60, 66, 66, 40, 30};
  put(folder + "/camera-intrinsics.txt", "66 0 39.5\n0 66 29.5\n0 0 1\n");
  std::vector<Pose> poses;
  for (int f = 0; f < frames; ++f) {
    const double angle = 2 * pi * f / frames;
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity(); // looks level outwards from a small circle
    T.linear().col(2) << std::cos(angle), std::sin(angle), 0;
    T.linear().col(1) << 0, 0, -1;
    T.linear().col(0) = T.linear().col(1).cross(T.linear().col(2));
    T.translation() = Eigen::Vector3d(2, 1.5, 1.3) + 0.2 * T.linear().col(2);
    Image16 depth{camera.width, camera.height, {}};
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x) {
        const Eigen::Vector3d beam = unproject(camera, {x + 0.5, y + 0.5});
        const Eigen::Vector3d place = wallPoint(T.translation(), T.linear() * beam);
        depth.data.push_back(std::uint16_t(std::lround(1000 * (T.inverse() * place).z())));
      }
    const std::string stem = folder + "/frame-" + std::to_string(100000 + f);
    writeImage(stem + ".color.jpg", photographRoom(camera, T.inverse()));
    writeImage(stem + ".depth.png", depth);
    poses.emplace_back(T.matrix());
  }
  writePoses(folder + "/poses.txt", poses);
}

/// What writeLayout() makes layouts of: a small room with all that fresco_scan writes.
inline std::string layoutSource(const std::string& folder, Index beams = 3000)
{
  writeSmallRoom(folder, beams);
  const std::vector<Pose> poses = readPoses(folder + "/poses.txt");
  CameraSet set = readColmap(folder + "/cameras");
  writeColmap(folder + "/cameras", set, sparseRoom(set, 600));
  fs::create_directory(folder + "/panoramas");
  for (int k = 0; k < 2; ++k) {
    const CameraModel camera = sphericalCamera(128, 64);
    Eigen::Matrix3d R_camera_scan; // the middle looks along x, z is up
    R_camera_scan << 0, -1, 0, 0, 0, -1, 1, 0, 0;
    Image image(camera.width, camera.height);
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x) {
        const Eigen::Vector3d beam = R_camera_scan.transpose() * direction(camera, {x + 0.5, y + 0.5});
        const auto color = wallColor(wallPoint(poses[k]->topRightCorner<3, 1>(), beam));
        std::copy(color.data(), color.data() + 3, image.pixel(x, y));
      }
    writeImage(folder + "/panoramas/scan_0" + std::to_string(k) + ".jpg", image);
  }
  simulation::writeSurvey(folder, poses, {});
  writeRgbdRoom(folder + "/rgbd", 12);
  return folder;
}

/// Folder of the source that the tests of this program lay out; programs run at once.
inline std::string sourceFolder() { return buildFolder() + "/scratch/source_of_" + program_invocation_short_name; }

/// Tests that lay out one source, which is written once.
class Inputs : public testing::Test {
protected:
  static void SetUpTestSuite()
  {
    fs::remove_all(sourceFolder());
    layoutSource(sourceFolder());
  }

  /// The layout as folder `x` of a folder of its own.
  std::string laidOut(const std::string& layout)
  {
    const std::string folder = scratchFolder();
    simulation::writeLayout(layout, sourceFolder(), folder + "/x");
    return folder;
  }
};
} // namespace fresco::test
