// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan/scan_free_space.h"
#include <array>
#include <fresco/core/point_set.h>
#include <fresco/search/neighbors.h>
#include <memory>
#include <string>
#include <vector>
namespace fresco::registration {
/// One scan at one resolution, in the scan's working frame.
struct ScanLevel {
  float voxel = 0.f;                     ///< edge of the thinning cells, length
  Points points;                         ///< 3xN, one per cell, the mean of its points
  std::shared_ptr<const PointTree> tree; ///< over them
  Points viewpoints;                     ///< 3xN
  Points colors;                         ///< 3xN, means over the cells, or 3x0
  Points normals;                        ///< 3xN unit, zero where the neighbours do not span a plane
  Eigen::VectorXf bend;                  ///< N, smallest eigenvalue / sum of eigenvalues of the neighbourhood, 0..1/3
  std::vector<Index> samples;            ///< points with a normal; any prefix covers all directions of normals
};

/// A motion other than the identity that maps a part of a scan onto another part of it: two places that look alike.
struct SelfMotion {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity(); ///< in the scan's working frame
  bool certain = false;  ///< nothing that the scan saw speaks against it; else it is worth a try
  double likeness = 0.0; ///< overlap of the scan with itself, if the motion would pass as a pair's; else 0
  bool glimpsed = false; ///< whether little of the second place was seen, as through two doors
};
using SelfMotions = std::vector<SelfMotion, Eigen::aligned_allocator<SelfMotion>>;

/// What registration keeps of a scan.
struct PreparedScan {
  std::string problem;                              ///< why it cannot be registered; empty = it can
  Eigen::Vector3d center = Eigen::Vector3d::Zero(); ///< scan = center + working
  double size = 0.0;                                ///< median distance of its points from where they were seen, length
  bool oriented = false;                            ///< normals point to the free side; else their sign means nothing
  std::vector<ScanLevel> levels;                    ///< coarse to fine
  FreeSpace free_space;                             ///< empty unless oriented
  SelfMotions twins;                                ///< found by findSelfMotions()
};

constexpr int level_count = 4;            ///< resolutions
constexpr double voxels_per_size = 100.0; ///< finest thinning: a room of 3 m radius in 3 cm cells

/// Level on which two scans are compared: fine enough for furniture, coarser than the errors of a measured pose.
constexpr int check_level = level_count - 2;

/// Median distance of the finite points from the viewpoints (the scan's origin if unknown), length; 0 if there are
/// none.
double scanSize(const PointSet& scan);

/// How far the scan looks one way: length of the mean direction in which its points were seen, 0 all around .. 1.
double narrowness(const PointSet& scan);

/// The smallest voxel, `least` or more, that a scan of this density fills; length.
double fittingVoxel(const PointSet& scan, double least);

/// For a scan whose viewpoint turned out wrong: no free space, normals towards the middle of the scan.
void distrustViewpoint(PreparedScan& scan);

/// Edges of the cells of all levels; the same for all scans that are to be compared.
struct Thinning {
  /// Each level has cells of twice the edge.
  /// @param voxel finest, length
  explicit Thinning(double voxel) : Thinning(voxel, 0.0, 0.0) {}
  /// The same, but of scans that look one way all but the finest are not made coarser than in
  /// dense scans, if there are only few points: there would not be enough of them in what little such a scan sees.
  /// @param size  of the scans, length
  /// @param narrowness of the scans
  Thinning(double voxel, double size, double narrowness);
  std::array<float, level_count> voxels; ///< fine to coarse
};

PreparedScan prepareScan(const PointSet& scan, const Thinning& thinning, int threads);
} // namespace fresco::registration
