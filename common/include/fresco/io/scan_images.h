// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <fresco/core/camera.h>
#include <fresco/core/export.h>
#include <fresco/core/types.h>
#include <optional>
#include <string>
#include <vector>
namespace fresco {
/// A picture in a file of scans: images2D of .e57 (ASTM E2807-11, 8.4.7). Frame of a picture: x to the right, y up, it
/// looks along -z (pinhole); x to the middle of the picture, z up (spherical, cylindrical).
struct ScanImage {
  enum class Projection { none, pinhole, spherical, cylindrical }; ///< none: a picture to look at, of no known place
  enum class Encoding { jpeg, png };

  std::string name;
  Index scan = -1; ///< that it belongs to, from 0; -1 = none
  Projection projection = Projection::none;
  Encoding encoding = Encoding::jpeg;
  bool has_mask = false;
  int width = 0, height = 0;                     ///< pixels
  std::optional<Eigen::Isometry3d> T_file_image; ///< nothing where the file does not say
  double focal_length = 0;                       ///< metres, pinhole
  double pixel_width = 0, pixel_height = 0; ///< metres (pinhole), radians (spherical); cylindrical: radians, metres
  double principal_x = 0, principal_y = 0;  ///< pixels; x of pinhole only
  double radius = 0;                        ///< metres, cylindrical
};

/// What the file says of its pictures; none for formats that hold no pictures.
/// @throws std::runtime_error "PATH: reason" if the file cannot be read or is malformed
FRESCO_EXPORT std::vector<ScanImage> readScanImages(const std::string& path);

/// The JPEG or PNG file of a picture, and that of its mask (PNG, pixels that are not 0 are valid).
/// @param image index into readScanImages()
/// @throws std::runtime_error "PATH: reason" if there is no such picture or its bytes are damaged
FRESCO_EXPORT std::string readScanImageBytes(const std::string& path, Index image);
FRESCO_EXPORT std::string readScanImageMask(const std::string& path, Index image);

/// Camera of a pinhole picture, without distortion; axes as CameraModel has them (y down, z forward).
struct ScanCamera {
  CameraModel camera;
  Eigen::Isometry3d T_camera_file;
};

/// From the frame of a picture to that of a camera at its place.
FRESCO_EXPORT Eigen::Isometry3d cameraAxes(ScanImage::Projection projection);

/// @throws std::invalid_argument unless the picture is pinhole, has a pose, pixels and a focal length above 0
FRESCO_EXPORT ScanCamera cameraOf(const ScanImage& image);
} // namespace fresco
