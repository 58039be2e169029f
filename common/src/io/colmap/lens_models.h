// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/camera.h>
#include <string>
#include <vector>
namespace fresco::io {
/// A camera model of COLMAP, as colmap/src/base/camera_models.h defines it.
struct LensModel {
  const char* name;
  int number; ///< in binary files
  CameraProjection projection;
  /// In the order of the files. Models with one focal length have no fy.
  std::vector<double CameraModel::*> parameters;
};

/// By COLMAP's name, and by its number in binary files. @throws std::runtime_error "`where`: ..." if fresco does not read
/// that model
const LensModel& lensModelNamed(const std::string& name, const std::string& where);
const LensModel& lensModelNumbered(int number, const std::string& where);

/// The simplest model with two focal lengths that has all parameters of the camera.
/// @throws std::invalid_argument for a spherical camera, which COLMAP does not have
const LensModel& lensModelOf(const CameraModel& camera);
} // namespace fresco::io
