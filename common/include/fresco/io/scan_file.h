// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <fresco/core/export.h>
#include <fresco/core/point_set.h>
#include <fresco/core/poses.h>
#include <fresco/io/cloud_file.h>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>
/// Files of several scans (.e57, .ptx): each scan is a cloud in the frame of its scanner, with its place in the frame of
/// the file.
namespace fresco {
namespace io {
struct ScanIndex;
}

/// What a file says of one of its scans before the points are read.
struct ScanInfo {
  std::string name;      ///< as the file calls it; may be empty
  Index points = 0;      ///< as announced, invalid ones included
  bool has_pose = false; ///< whether the file says where the scan belongs
  Eigen::Isometry3d T_file_scan = Eigen::Isometry3d::Identity();
  std::optional<Eigen::Vector3d> sensor;          ///< position in the frame of the scan, where known
  std::optional<Eigen::Array2d> intensity_limits; ///< lowest and highest that the scanner can give, where known
};

/// One scan of a file, or the whole file.
struct FRESCO_EXPORT ScanPath {
  std::string file;
  Index scan = -1; ///< from 0; -1 = all scans as one cloud, in the frame of the file
  /// Where the scans of a text file begin, as scansOf() found it: each of them is then read without a look at the others.
  /// Without it, or if the file has changed since, they are searched.
  std::shared_ptr<const io::ScanIndex> index = nullptr;

  /// "FILE", or "FILE scan N" with N from 1.
  std::string name() const;
};

/// Whether the format of `path` may hold several scans with poses; the file need not exist.
FRESCO_EXPORT bool holdsScans(const std::string& path);

/// The scans of a file whose format holdsScans().
/// @throws std::runtime_error "PATH: reason" if it cannot be read, is malformed or has no scan
FRESCO_EXPORT std::vector<ScanInfo> readScanInfos(const std::string& path);
FRESCO_EXPORT std::vector<ScanInfo> readScanInfos(const ScanPath& path); ///< of its whole file

/// The scans in files of points: one each, or as many as a file that holdsScans() has. A file without a scan is left out, which
/// listeners hear, where others have one.
/// @param keep_broken a file that cannot be listed counts as one scan, whose reading then throws
/// @throws std::runtime_error as readScanInfos()
FRESCO_EXPORT std::vector<ScanPath> scansOf(const std::vector<std::string>& files, bool keep_broken = false);

/// World from scan as the files themselves say; nothing where they do not.
FRESCO_EXPORT std::vector<Pose> posesOf(const std::vector<ScanPath>& scans);

/// As readPoints() and readCloud(), of one scan in its own frame, with the sensor as viewpoint; or of the whole file. A
/// scan without points is an empty set for readPoints().
/// @throws std::runtime_error "PATH: reason", also if there is no such scan
FRESCO_EXPORT PointSet readPoints(const ScanPath& path);
FRESCO_EXPORT CloudFile readCloud(const ScanPath& path);

/// Hands the points of one scan, in its own frame and the order of the file, to `receive` in windows: a file may be
/// larger than memory. Stops where `receive` answers false. For formats that are not read in windows, one window.
/// @param window points, >= 1
/// @throws std::runtime_error as readPoints(), std::invalid_argument for the window
FRESCO_EXPORT void streamPoints(const ScanPath& path, Index window,
                                const std::function<bool(const PointSet&)>& receive);
} // namespace fresco
