// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <filesystem>
#include <fresco/core/point_set.h>
#include <fresco/core/poses.h>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/pose_file.h>
#include <iomanip>
#include <string>
#include <vector>
namespace fresco::simulation {
/// From where to where.
struct Copy {
  const std::string &from, &to;

  std::vector<Pose> poses(const std::string& file = "/poses.txt") const { return readPoses(from + file); }
  std::string scan(std::size_t k) const
  {
    return concat(from, "/scans/scan_", std::setfill('0'), std::setw(2), k, ".pcd");
  }
  void folder(const std::string& source, const std::string& target) const
  {
    makeFolder(to + "/" + target);
    std::filesystem::copy(from + "/" + source, to + "/" + target,
                          std::filesystem::copy_options::recursive | std::filesystem::copy_options::overwrite_existing);
  }
};

inline std::string numbered(std::size_t k, int digits) { return concat(std::setfill('0'), std::setw(digits), k); }

inline std::string matrixText(const Eigen::Matrix4d& T)
{
  std::string text;
  for (int r = 0; r < 4; ++r)
    text += concat(std::setprecision(12), T(r, 0), " ", T(r, 1), " ", T(r, 2), " ", T(r, 3), "\n");
  return text;
}

inline std::string quaternionText(const Eigen::Matrix4d& T, const char* between)
{
  const Eigen::Quaterniond q(Eigen::Matrix3d(T.topLeftCorner<3, 3>()));
  return concat(std::setprecision(12), T(0, 3), between, T(1, 3), between, T(2, 3), between, q.x(), between, q.y(),
                between, q.z(), between, q.w());
}

/// All scans in the frame of poses.txt, without a word of where they were seen from.
PointSet mergedCloud(const Copy& copy);

/// A cloud with its photographs and their cameras.
void writeMetashape(const Copy& copy);
void writeBundler(const Copy& copy);
void writeNvm(const Copy& copy);
void writeTransforms(const Copy& copy);
void writeOpenMvg(const Copy& copy);

/// Layouts of RGB-D frames.
void writeSevenScenes(const Copy& copy);
void writeTum(const Copy& copy);
void writeOpen3d(const Copy& copy);
void writeRedwood(const Copy& copy);
void writeScanNet(const Copy& copy);
void writeStray(const Copy& copy);
void writePolycam(const Copy& copy);
void writeMatterport(const Copy& copy);
} // namespace fresco::simulation
