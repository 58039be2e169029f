// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan/scan_planes.h"
#include <fresco/registration/core/sc2_pcr.h>
namespace fresco::registration {
/// Distinctive points of a scan with a description of what lies around them, in its working frame.
struct ScanFeatures : OrientedPoints {
  Eigen::MatrixXf descriptors; ///< 33xK, fast point feature histograms
  ScanPlanes planes;
};

/// FPFH of all points of the second level; kept where they differ most from the scan's mean, one per neighbourhood of about
/// a voxel, the most distinctive first.
ScanFeatures describeScan(const PreparedScan& scan, int threads);
} // namespace fresco::registration
