// SPDX-License-Identifier: BSD-3-Clause
#include "sensors/layout_copy.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/camera.h>
#include <fresco/io/image_io.h>
#include <fresco/io/rgbd_folder.h>
#include <fresco/simulation/sensors/layout_files.h>
namespace fresco::simulation {
namespace {
namespace fs = std::filesystem;

/// Camera that looks along -z with y up.
Eigen::Matrix4d lookingBack(const Eigen::Matrix4d& T) { return T * Eigen::Vector4d(1, -1, -1, 1).asDiagonal(); }

struct Video {
  RgbdFolderFiles files;
  std::vector<Pose> poses;
  explicit Video(const Copy& copy) : files(listRgbdFolder(copy.from + "/rgbd")), poses(copy.poses("/rgbd/poses.txt")) {}
};

/// A depth image in another unit. @param units of millimetres a unit of the layout
void copyDepth(const std::string& from, const std::string& to, double millimetres)
{
  Image16 depth = readImage16(from);
  for (std::uint16_t& value : depth.data)
    value = value == 65535 ? 0 : std::uint16_t(std::min(65535.0, std::round(value / millimetres)));
  writeImage(to, depth);
}

/// Both images of each frame, named by number.
void copyFrames(const Copy& copy, const Video& video, const std::string& color, int digits)
{
  makeFolder(copy.to + "/" + color);
  makeFolder(copy.to + "/depth");
  for (std::size_t f = 0; f < video.poses.size(); ++f) {
    fs::copy(video.files.frames[f].color, copy.to + "/" + color + "/" + numbered(f, digits) + ".jpg",
             fs::copy_options::overwrite_existing);
    copyDepth(video.files.frames[f].depth, copy.to + "/depth/" + numbered(f, digits) + ".png", 1);
  }
}

std::string poseLog(const Video& video)
{
  std::string log;
  for (std::size_t f = 0; f < video.poses.size(); ++f)
    log += concat(f, " ", f, " ", f + 1, "\n") + matrixText(*video.poses[f]);
  return log;
}

void writeTrust(const std::string& file, const Image16& depth, std::uint8_t trusted)
{
  Image trust(depth.width, depth.height, 1);
  for (std::size_t i = 0; i < depth.data.size(); ++i)
    trust.data[i] = depth.data[i] == 0 || i % 50 == 0 ? 0 : trusted;
  writeImage(file, trust);
}
} // namespace

void writeSevenScenes(const Copy& copy)
{
  const Video video(copy);
  fs::copy(copy.from + "/rgbd/camera-intrinsics.txt", copy.to, fs::copy_options::overwrite_existing);
  for (std::size_t f = 0; f < video.poses.size(); ++f) {
    const auto& frame = video.files.frames[f];
    fs::copy(frame.color, copy.to, fs::copy_options::overwrite_existing);
    fs::copy(frame.depth, copy.to, fs::copy_options::overwrite_existing);
    writeFile(copy.to + "/" + frame.name + ".pose.txt", matrixText(*video.poses[f]));
  }
}

void writeTum(const Copy& copy)
{
  const Video video(copy);
  makeFolder(copy.to + "/rgb");
  makeFolder(copy.to + "/depth");
  std::string colors = "# color images\n", depths = "# depth maps\n", poses = "# timestamp tx ty tz qx qy qz qw\n";
  for (std::size_t f = 0; f < video.poses.size(); ++f) {
    const std::string color_time = concat(std::fixed, std::setprecision(6), 1305031102.175 + f / 30.0),
                      depth_time = concat(std::fixed, std::setprecision(6), 1305031102.160 + f / 30.0);
    writeImage(copy.to + "/rgb/" + color_time + ".png", readImage(video.files.frames[f].color));
    copyDepth(video.files.frames[f].depth, copy.to + "/depth/" + depth_time + ".png", 0.2);
    colors += color_time + " rgb/" + color_time + ".png\n";
    depths += depth_time + " depth/" + depth_time + ".png\n";
    poses += color_time + " " + quaternionText(*video.poses[f], " ") + "\n";
  }
  writeFile(copy.to + "/rgb.txt", colors);
  writeFile(copy.to + "/depth.txt", depths);
  writeFile(copy.to + "/groundtruth.txt", poses);
  fs::copy(copy.from + "/rgbd/camera-intrinsics.txt", copy.to, fs::copy_options::overwrite_existing);
}

void writeOpen3d(const Copy& copy)
{
  const Video video(copy);
  copyFrames(copy, video, "color", 6);
  const CameraModel& camera = video.files.camera;
  writeFile(copy.to + "/camera_intrinsic.json",
            concat("{\"width\": ", camera.width, ", \"height\": ", camera.height, ", \"intrinsic_matrix\": [",
                   camera.fx, ", 0, 0, 0, ", camera.fy, ", 0, ", camera.cx - 0.5, ", ", camera.cy - 0.5, ", 1]}\n"));
  writeFile(copy.to + "/trajectory.log", poseLog(video));
}

/// Redwood's frames are of 640x480, so images of another size are brought to that.
void writeRedwood(const Copy& copy)
{
  const Video video(copy);
  makeFolder(copy.to + "/rgb");
  makeFolder(copy.to + "/depth");
  for (std::size_t f = 0; f < video.poses.size(); ++f) {
    writeImage(copy.to + "/rgb/" + numbered(f + 1, 7) + "-" + numbered(33333 * f, 12) + ".jpg",
               enlarged(readImage(video.files.frames[f].color), 640, 480));
    writeImage(copy.to + "/depth/" + numbered(f + 1, 7) + "-" + numbered(33333 * f + 900, 12) + ".png",
               enlarged(readImage16(video.files.frames[f].depth), 640, 480));
  }
  writeFile(copy.to + "/scene-traj.log", poseLog(video));
}

void writeScanNet(const Copy& copy)
{
  const Video video(copy);
  copyFrames(copy, video, "color", 1);
  for (const char* part : {"/pose", "/intrinsic"})
    makeFolder(copy.to + part);
  const CameraModel& camera = video.files.camera;
  Eigen::Matrix4d K = Eigen::Matrix4d::Identity();
  K(0, 0) = camera.fx, K(1, 1) = camera.fy, K(0, 2) = camera.cx - 0.5, K(1, 2) = camera.cy - 0.5;
  for (const char* which : {"depth", "color"})
    writeFile(copy.to + "/intrinsic/intrinsic_" + which + ".txt", matrixText(K));
  for (std::size_t f = 0; f < video.poses.size(); ++f)
    writeFile(copy.to + "/pose/" + numbered(f, 1) + ".txt", matrixText(*video.poses[f]));
}

/// Colours as pictures in rgb/, as of a video that was unpacked.
void writeStray(const Copy& copy)
{
  const Video video(copy);
  copyFrames(copy, video, "rgb", 6);
  makeFolder(copy.to + "/confidence");
  const CameraModel& camera = video.files.camera;
  writeFile(copy.to + "/camera_matrix.csv", concat(camera.fx, ", 0.0, ", camera.cx - 0.5, "\n0.0, ", camera.fy, ", ",
                                                   camera.cy - 0.5, "\n0.0, 0.0, 1.0\n"));
  std::string odometry = "timestamp, frame, x, y, z, qx, qy, qz, qw\n";
  for (std::size_t f = 0; f < video.poses.size(); ++f) {
    odometry += concat(7000 + f / 60.0, ", ", numbered(f, 6), ", ", quaternionText(*video.poses[f], ", "), "\n");
    writeTrust(copy.to + "/confidence/" + numbered(f, 6) + ".png", readImage16(video.files.frames[f].depth), 2);
  }
  writeFile(copy.to + "/odometry.csv", odometry);
}

void writePolycam(const Copy& copy)
{
  const Video video(copy);
  const std::string top = copy.to + "/keyframes";
  for (const char* part : {"/images", "/cameras", "/depth", "/confidence"})
    makeFolder(top + part);
  const CameraModel& camera = video.files.camera;
  Eigen::Matrix4d y_up = Eigen::Matrix4d::Identity();
  y_up.topLeftCorner<3, 3>() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  for (std::size_t f = 0; f < video.poses.size(); ++f) {
    const std::string name = std::to_string(1442008525605 + 33333 * f);
    const auto& frame = video.files.frames[f];
    fs::copy(frame.color, top + "/images/" + name + ".jpg", fs::copy_options::overwrite_existing);
    copyDepth(frame.depth, top + "/depth/" + name + ".png", 1);
    writeTrust(top + "/confidence/" + name + ".png", readImage16(frame.depth), 255);
    const Eigen::Matrix4d T = y_up * lookingBack(*video.poses[f]);
    std::string json = concat("{\"width\": ", camera.width, ", \"height\": ", camera.height, ", \"fx\": ", camera.fx,
                              ", \"fy\": ", camera.fy, ", \"cx\": ", camera.cx, ", \"cy\": ", camera.cy);
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c)
        json += concat(std::setprecision(12), ", \"t_", r, c, "\": ", T(r, c));
    writeFile(top + "/cameras/" + name + ".json", json + ", \"blur_score\": 100}\n");
  }
}

void writeMatterport(const Copy& copy)
{
  const Video video(copy);
  for (const char* part : {"/undistorted_color_images", "/undistorted_depth_images", "/undistorted_camera_parameters"})
    makeFolder(copy.to + part);
  const CameraModel& camera = video.files.camera;
  std::string lines = concat("dataset matterport\nn_images ", video.poses.size(),
                             "\ndepth_directory undistorted_depth_images\ncolor_directory undistorted_color_images\n",
                             "intrinsics_matrix ", camera.fx, " 0 ", camera.cx, " 0 ", camera.fy, " ",
                             camera.height - camera.cy, " 0 0 1\n");
  for (std::size_t f = 0; f < video.poses.size(); ++f) {
    const std::string stem = "0f37bd0737e349de9d536263a4bdd60d_", place = numbered(f / 6, 1) + "_" + numbered(f % 6, 1);
    fs::copy(video.files.frames[f].color, copy.to + "/undistorted_color_images/" + stem + "i" + place + ".jpg",
             fs::copy_options::overwrite_existing);
    copyDepth(video.files.frames[f].depth, copy.to + "/undistorted_depth_images/" + stem + "d" + place + ".png", 0.25);
    std::string matrix = matrixText(lookingBack(*video.poses[f]));
    std::replace(matrix.begin(), matrix.end(), '\n', ' ');
    lines += "scan " + stem + "d" + place + ".png " + stem + "i" + place + ".jpg " + matrix + "\n";
  }
  writeFile(copy.to + "/undistorted_camera_parameters/house.conf", lines);
}
} // namespace fresco::simulation
