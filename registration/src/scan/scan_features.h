// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan/scan_planes.h"
#include <fresco/registration/core/sc2_pcr.h>
namespace fresco::registration {
/// Distinctive points of a scan with a description of what lies around them, in its working frame.
struct ScanFeatures : OrientedPoints {
  Eigen::MatrixXf descriptors; ///< 33xK, see computeFpfh()
  ScanPlanes planes;
};

struct FeatureOptions {
  int level = 1;      ///< index into PreparedScan::levels
  float radius = 5.f; ///< of the neighbourhood described, voxels of the level
  Index most = 1200;  ///< features kept, the most distinctive first
  int threads = 0;
};

/// FPFH of all points of a level; kept where they differ most from the scan's mean, one per neighbourhood of about a
/// voxel.
ScanFeatures describeScan(const PreparedScan& scan, const FeatureOptions& options);
} // namespace fresco::registration
