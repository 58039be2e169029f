// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/image.h>
#include <fresco/io/scan_file.h>
#include <fresco/io/scan_images.h>
#include <string>
#include <vector>
namespace fresco::model {
/// A picture inside a file of scans (images2D of .e57) whose place is known. It moves with a scan.
struct ScanPicture {
  std::string file;
  Index number = 0; ///< index into readScanImages()
  ScanImage what;
  Index scan = 0; ///< the scan that it belongs to, else the nearest of its file: index into the scans of the model
  Eigen::Isometry3d T_camera_scan = Eigen::Isometry3d::Identity();

  bool isPanorama() const { return what.projection != ScanImage::Projection::pinhole; }
  std::string name() const; ///< "FILE picture N", N from 1
};

struct ScanPictures {
  std::vector<ScanPicture> pictures;
  std::vector<std::string> warnings; ///< what of them cannot be used, a line each
};

/// Pictures of the files that `scans` are in. Without a pose or without a projection a picture is of no use.
ScanPictures picturesOf(const std::vector<ScanPath>& scans);

/// A picture as a camera takes it.
struct CameraPicture {
  CameraModel camera; ///< perspective or spherical
  Image image;        ///< of the camera's size
  Image mask;         ///< grey, 0 = nothing is known there, else 255; empty: all is known
  bool as_stored;     ///< whether `image` is the picture of the file as it is
};

/// Decodes it. Cylindrical and partial spherical pictures become panoramas of all directions.
/// @throws std::runtime_error "FILE picture N: reason" if it is damaged, of another size than the file says, or its angles
///         or focal length are impossible
CameraPicture readPicture(const ScanPicture& picture);
} // namespace fresco::model
