// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cmath>
#include <fresco/core/similarity.h>
#include <fresco/io/colmap.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/point_io.h>
#include <fresco/io/pose_file.h>
#include <string>
namespace fresco::test {
inline const Eigen::Vector3d& roomSize()
{
  static const Eigen::Vector3d size(4.0, 3.0, 2.5);
  return size;
}

/// Where the ray meets the walls of the box (0,0,0)..roomSize() from inside.
inline Eigen::Vector3d wallPoint(const Eigen::Vector3d& from, const Eigen::Vector3d& direction)
{
  double t = 1e9;
  for (int k = 0; k < 3; ++k)
    if (direction[k] != 0)
      t = std::min(t, ((direction[k] > 0 ? roomSize()[k] : 0.0) - from[k]) / direction[k]);
  return from + t * direction;
}

/// Paint of the walls: waves, so that photographs have something to agree on.
inline Eigen::Matrix<std::uint8_t, 3, 1> wallColor(const Eigen::Vector3d& p)
{
  const auto wave = [](double x) { return static_cast<std::uint8_t>(128 + 100 * std::sin(x)); };
  return {wave(5 * p.x() + 3 * p.z()), wave(7 * p.y() - 2 * p.x()), wave(9 * p.z() + 4 * p.y())};
}

/// A scan from `station`, in the scanner's own frame: beams on a Fibonacci lattice.
inline PointSet scanRoom(const Eigen::Vector3d& station, Index beams)
{
  PointSet scan;
  scan.points.resize(3, beams);
  scan.colors.resize(3, beams);
  for (Index i = 0; i < beams; ++i) {
    const double z = 1 - (2 * i + 1.0) / static_cast<double>(beams), angle = 2.399963229728653 * static_cast<double>(i);
    const double r = std::sqrt(1 - z * z);
    const Eigen::Vector3d p = wallPoint(station, {r * std::cos(angle), r * std::sin(angle), z});
    scan.points.col(i) = (p - station).cast<float>();
    scan.colors.col(i) = wallColor(p);
  }
  return scan;
}

inline Image photographRoom(const CameraModel& camera, const Eigen::Isometry3d& T_camera_world)
{
  Image image(camera.width, camera.height);
  const Eigen::Isometry3d T_world_camera = T_camera_world.inverse();
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector3d beam = T_world_camera.linear() * unproject(camera, {x + 0.5, y + 0.5});
      const auto color = wallColor(wallPoint(T_world_camera.translation(), beam));
      std::copy(color.data(), color.data() + 3, image.pixel(x, y));
    }
  return image;
}

/// Points of the walls as structure from motion finds them with the cameras of `set`, a fifth of them wrong.
inline SparsePoints sparseRoom(const CameraSet& set, Index count)
{
  SparsePoints points;
  for (Index i = 0; i < count; ++i) {
    const int v = static_cast<int>(i) % static_cast<int>(set.views.size());
    const CameraModel& camera = set.cameras[set.views[v].camera];
    const Eigen::Vector2d pixel(std::fmod(0.754877666 * i, 1.0) * camera.width,
                                std::fmod(0.569840296 * i, 1.0) * camera.height);
    const Eigen::Vector3d eye = set.views[v].center(),
                          place = wallPoint(eye, set.views[v].T_camera_world.linear().transpose() *
                                                     unproject(camera, pixel));
    SparsePoint point;
    point.position = i % 5 == 0 ? Eigen::Vector3d(eye + 0.6 * (place - eye)) : place;
    point.color = wallColor(place);
    point.track = {{v, pixel}};
    points.push_back(point);
  }
  return points;
}

/// A frame and a scale of its own.
inline Similarity smallRoomsOwnFrame()
{
  return {0.02, Eigen::Quaterniond(0.3, -0.5, 0.7, 0.4).normalized().toRotationMatrix(), {0.3, -0.1, 0.7}};
}

/// Input folder of fresco_model: an empty box of a room, two scans with poses, four photographs.
inline void writeSmallRoom(const std::string& folder, Index beams = 6000)
{
  for (const char* part : {"/scans", "/cameras", "/images"})
    makeFolder(folder + part);
  std::vector<Pose> poses;
  for (const Eigen::Vector3d& station : {Eigen::Vector3d(1.2, 1.1, 1.3), Eigen::Vector3d(2.9, 1.8, 1.2)}) {
    writePoints(folder + "/scans/scan_0" + std::to_string(poses.size()) + ".pcd", scanRoom(station, beams));
    Eigen::Matrix4d T_world_scan = Eigen::Matrix4d::Identity();
    T_world_scan.topRightCorner<3, 1>() = station;
    poses.emplace_back(T_world_scan);
  }
  writePoses(folder + "/poses.txt", poses);
  CameraSet set;
  set.cameras = {{160, 120, 90, 90, 80, 60, 0, 0, 0, 0}};
  for (int i = 0; i < 4; ++i) {
    View view;
    view.image = "view_" + std::to_string(i) + ".png";
    const double angle = i * EIGEN_PI / 2;
    Eigen::Matrix3d R_camera_world; // looks level, along `angle`
    R_camera_world << std::sin(angle), -std::cos(angle), 0, 0, 0, -1, std::cos(angle), std::sin(angle), 0;
    view.T_camera_world.linear() = R_camera_world;
    view.T_camera_world.translation() = -(R_camera_world * Eigen::Vector3d(2.0, 1.5, 1.4));
    writeImage(folder + "/images/" + view.image, photographRoom(set.cameras[0], view.T_camera_world));
    set.views.push_back(view);
  }
  writeColmap(folder + "/cameras", set);
}

/// A small room in `folder`, and its cameras with sparse points in a frame of their own in the folder `cameras`.
inline void writeOwnFrameRoom(const std::string& folder, const std::string& cameras)
{
  writeSmallRoom(folder, 20000);
  CameraSet set = readColmap(folder + "/cameras");
  SparsePoints points = sparseRoom(set, 2000);
  transformCameras(smallRoomsOwnFrame(), set, points);
  writeColmap(cameras, set, points);
}
} // namespace fresco::test
