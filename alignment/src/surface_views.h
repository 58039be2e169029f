// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan_surface.h"
#include <fresco/core/camera.h>
#include <opencv2/core.hpp>
namespace fresco::alignment {
/// What the scans look like from a place.
struct SurfaceView {
  cv::Mat1b gray;  ///< holes filled smoothly
  cv::Mat1f depth; ///< z; 0 where no point is near
};

/// Draws the points of the scans, by their colours, else their intensities.
class SurfacePainter {
public:
  SurfacePainter(const PointSet& scans, const ScanSurface& surface);

  bool hasGray() const { return !grays_.empty(); }
  double focal() const { return focal_; } ///< of a camera that shows two pixels a point at a typical distance, pixels

  /// @param camera a pinhole without distortion @param T_camera_surface camera from ScanSurface's frame
  SurfaceView draw(const CameraModel& camera, const Eigen::Isometry3d& T_camera_surface) const;

private:
  Points points_;
  std::vector<float> grays_; ///< 0..255
  double spacing_ = 0;       ///< of neighbouring points, about, length
  double focal_ = 0;
};

/// Places in the free space between the surfaces, spread evenly: where people with cameras may have stood.
std::vector<Eigen::Vector3d> freePlaces(const ScanSurface& surface, std::size_t most);
} // namespace fresco::alignment
