// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan/prepared_scan.h"
namespace fresco::registration {
/// Distinctive points of a scan with a description of what lies around them, in its working frame.
struct ScanFeatures {
  Points points;               ///< 3xK
  Points normals;              ///< 3xK unit
  Eigen::MatrixXf descriptors; ///< 33xK, square roots of histograms: unit length, so that distances compare histograms
};

struct FeatureOptions {
  int level = 1;      ///< index into PreparedScan::levels
  float radius = 5.f; ///< of the neighbourhood described, voxels of the level
  Index most = 1200;  ///< features kept, the most distinctive first
  int threads = 0;
};

/// Fast point feature histograms (Rusu, Blodow, Beetz 2009, "Fast Point Feature Histograms (FPFH) for 3D Registration")
/// of all points of a level; kept where they differ most from the scan's mean, one per neighbourhood of about a voxel.
ScanFeatures describeScan(const PreparedScan& scan, const FeatureOptions& options);

/// Two features that look alike.
struct Correspondence {
  Index a = 0, b = 0;
};

/// For each feature of one scan the most similar of the other, in both directions; those that choose each other first,
/// then by distance of their descriptors.
std::vector<Correspondence> matchFeatures(const ScanFeatures& a, const ScanFeatures& b, std::size_t most);
} // namespace fresco::registration
