// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/points/text_numbers.h"
#include <fresco/core/poses.h>
#include <fresco/io/camera_files.h>
#include <map>
#include <string_view>
#include <vector>
namespace fresco::io {
/// What readers of camera files hand their findings to. Errors come without the path of the file.
class CameraFileBuilder {
public:
  /// @param path of the camera file @param images folder of the photographs; "" = not known
  CameraFileBuilder(const std::string& path, std::string images);

  /// Folder of the camera file, for what lies beside it.
  const std::string& folder() const { return folder_; }

  /// A pinhole camera of the size of a photograph, centred, without focal length.
  CameraModel cameraOf(const std::string& photograph) const;

  /// @param photograph as the file names it
  /// @param T_camera_world rigid within the digits that were written; axes x right, y down, z forward
  /// @return number of the view
  int addView(const std::string& photograph, const CameraModel& camera, const Eigen::Matrix4d& T_camera_world);

  /// @param color of 255
  void addPoint(const Eigen::Vector3d& position, const Eigen::Vector3d& color, const std::vector<Observation>& track);

  /// Pixel in the middle of a view's photograph.
  Eigen::Vector2d middleOf(int view) const;

  CameraFile take(); ///< @throws std::runtime_error if there is no view

private:
  std::string nameBelow(const std::string& told) const;
  std::string folder_, images_;
  std::multimap<std::string, std::string> by_stem_; ///< pictures below images_
  CameraFile file_;
};

/// How a program writes cameras. A row of the table in camera_files.cpp.
struct CameraFormat {
  const char* name;
  const char* extension;
  bool (*begins)(std::string_view head); ///< whether a file of that extension that begins so is one
  void (*read)(const std::string& content, CameraFileBuilder& cameras);
};

bool isMetashape(std::string_view head);
void readMetashape(const std::string& content, CameraFileBuilder& cameras);
bool isBundler(std::string_view head);
void readBundler(const std::string& content, CameraFileBuilder& cameras);
bool isNvm(std::string_view head);
void readNvm(const std::string& content, CameraFileBuilder& cameras);
bool isTransforms(std::string_view head);
void readTransforms(const std::string& content, CameraFileBuilder& cameras);
bool isOpenMvg(std::string_view head);
void readOpenMvg(const std::string& content, CameraFileBuilder& cameras);

/// Camera from world of axes x right, y down, z forward from those of OpenGL and Bundler: x right, y up, z back; and back.
inline Eigen::Matrix4d withTurnedAxes(const Eigen::Matrix4d& T_camera_world)
{
  return Eigen::Vector4d(1, -1, -1, 1).asDiagonal() * T_camera_world;
}

/// Numbers and words of a text one after the other.
struct Words {
  TextScanner scanner;

  template <typename T = double>
  T number()
  {
    return parseNumber<T>(scanner.wordAcrossLines());
  }
  template <int rows>
  Eigen::Matrix<double, rows, 1> vector()
  {
    Eigen::Matrix<double, rows, 1> v;
    for (double& value : v)
      value = number();
    return v;
  }
  Eigen::Matrix3d matrix() ///< by rows
  {
    return Eigen::Matrix<double, 3, 3, Eigen::RowMajor>(vector<9>().data());
  }
};

/// The points of Bundler and NVM: place, colour, and where which camera shows them, from the middle of the photograph.
struct PointRows {
  std::size_t count;
  std::vector<int> views; ///< of each camera; -1 = none
  double down;            ///< 1 if pixels count downwards, -1 upwards
};

void addPoints(Words& words, const PointRows& rows, CameraFileBuilder& cameras);

inline Eigen::Matrix4d rigid(const Eigen::Matrix3d& R, const Eigen::Vector3d& t)
{
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() = R;
  T.topRightCorner<3, 1>() = t;
  return T;
}
} // namespace fresco::io
