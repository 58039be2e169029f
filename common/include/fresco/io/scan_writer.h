// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/poses.h>
#include <fresco/io/cloud_file.h>
#include <fresco/io/scan_file.h>
#include <fresco/io/scan_images.h>
namespace fresco {
/// A scan to be written, in its own frame.
struct PlacedCloud {
  std::string name;
  std::optional<Eigen::Isometry3d> T_file_scan; ///< nothing where it is not known
  CloudFile cloud;                              ///< its own sensor pose does not count
};

/// A picture to be written.
struct ScanPicture {
  ScanImage description; ///< all but the size of the files
  std::string bytes;     ///< a JPEG or PNG file, as `description.encoding` says
  std::string mask;      ///< a PNG file; empty: none
};

/// Scans of a file that holdsScans(), and its pictures, as they are.
/// @throws std::runtime_error "PATH: reason"; a picture that cannot be read is remarked
FRESCO_EXPORT std::vector<PlacedCloud> readPlacedClouds(const std::string& path);
FRESCO_EXPORT std::vector<ScanPicture> readScanPictures(const std::string& path);

/// E57 (ASTM E2807): poses, every field with its type, organised clouds, pictures. Points that are not finite are marked
/// invalid. The file is made in memory.
/// @throws std::runtime_error "PATH: reason" if it cannot be written
/// @throws std::invalid_argument if a cloud has no x y z
FRESCO_EXPORT void writeScans(const std::string& path, const std::vector<PlacedCloud>& scans,
                              const std::vector<ScanPicture>& pictures = {});

/// writeScans() of those scans that have a pose (world from scan), with every field and the pictures of their files.
/// Pictures move with the scan that they belong to; those of no scan, or of one without a pose, are left out.
/// @throws std::runtime_error "PATH: reason"
/// @throws std::invalid_argument if the number of poses is another one
FRESCO_EXPORT void writeScansAt(const std::string& path, const std::vector<ScanPath>& scans,
                                const std::vector<Pose>& poses);
} // namespace fresco
