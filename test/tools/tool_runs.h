// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "common/shapes.h"
#include "test_data.h"
#include <algorithm>
#include <fresco/io/colmap.h>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <fresco/io/pose_file.h>
#include <fstream>
#include <sys/wait.h>
namespace fresco::test {
namespace fs = std::filesystem;

struct Outcome {
  int status = 0; ///< exit status, or 128 + signal
  std::string out, err;
};

inline void put(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

inline std::string get(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Runs `fresco_NAME ARGUMENTS` in the folder.
/// @param before the command: of a program that runs it
inline Outcome run(const std::string& folder, const std::string& command, const std::string& before = "")
{
  const std::string bin = buildFolder() + "/bin/fresco_";
  const std::string log = folder + "/.log";
  const std::string line = "cd '" + folder + "' && " + before + "'" + bin + command.substr(0, command.find(' ')) + "'" +
                           command.substr(std::min(command.size(), command.find(' '))) + " >" + log + ".out 2>" + log +
                           ".err </dev/null";
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), get(log + ".out"), get(log + ".err")};
}

/// Files in the folder and below, hidden ones included, without the logs.
inline std::vector<std::string> listing(const std::string& folder)
{
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().filename().string().rfind(".log", 0) != 0)
      names.push_back(entry.path().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// A folder with sound files: mesh.ply, cloud.pcd (with normals), poses.txt, cameras/, images/.
inline std::string soundFolder()
{
  std::string folder = test::scratchFolder();
  writeMesh(folder + "/mesh.ply", test::sphere(1.f, 3));
  PointSet cloud;
  cloud.points = test::sphere(1.f, 3).vertices;
  cloud.normals = cloud.points;
  cloud.viewpoints = Points::Zero(3, 1);
  writePoints(folder + "/cloud.pcd", cloud);
  writePoses(folder + "/poses.txt", {Eigen::Matrix4d::Identity().eval()});
  CameraSet cameras;
  cameras.cameras = {{64, 48, 60, 60, 32, 24, 0, 0, 0, 0}};
  View view;
  view.image = "a.png";
  view.T_camera_world.translation().z() = 4;
  cameras.views = {view};
  writeColmap(folder + "/cameras", cameras);
  fs::create_directory(folder + "/images");
  writeImage(folder + "/images/a.png", Image(64, 48, 3, 128));
  put(folder + "/empty.ply", "");
  put(folder + "/empty.pcd", "");
  const std::string mesh = get(folder + "/mesh.ply"), points = get(folder + "/cloud.pcd");
  put(folder + "/cut.ply", mesh.substr(0, mesh.size() * 2 / 3));
  put(folder + "/cut.pcd", points.substr(0, points.size() * 2 / 3));
  put(folder + "/noise.ply", std::string("\x01\x02 this is no file of any kind \xff\x00\x80", 33));
  put(folder + "/noise.pcd", std::string("\x01\x02 this is no file of any kind \xff\x00\x80", 33));
  put(folder + "/pointless.pcd", "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 0\nHEIGHT 1\n"
                                 "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 0\nDATA ascii\n");
  put(folder + "/pointless.ply", "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
                                 "property float z\nend_header\n");
  put(folder + "/mesh.doc", "mesh");
  return folder;
}

/// `command` ends with 1, says one line that contains `name`, and leaves the folder as it was.
inline void expectRefused(const std::string& folder, const std::string& command, const std::string& name)
{
  const auto before = listing(folder);
  const Outcome outcome = run(folder, command + " -quiet");
  EXPECT_EQ(outcome.status, 1) << command << "\n" << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << command << "\n" << outcome.err;
  EXPECT_NE(outcome.err.find(name), std::string::npos) << command << "\n" << outcome.err;
  EXPECT_EQ(listing(folder), before) << command;
}

inline const std::vector<std::string>& tools()
{
  static const std::vector<std::string> all = {"scan",     "filter",  "normals", "register", "reconstruct",
                                               "optimize", "texture", "compare", "snapshot", "model",
                                               "align",    "track",   "crop",    "simplify", "plan"};
  return all;
}

} // namespace fresco::test
