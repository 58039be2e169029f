// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "refinement/placement.h"
namespace fresco::registration {
/// Scans in one common frame.
struct ScanCluster {
  std::vector<Index> scans;
  IsometryVector poses; ///< frame of the cluster from working frame
  Refusal refusal = {}; ///< the last that kept it apart from another cluster
  std::vector<HintedJoin> hinted = {};
};

bool contains(const ScanCluster& cluster, Index scan);

/// Among the scans of the cluster, their number if it is none of them.
Index positionOf(const ScanCluster& cluster, Index scan);

/// Of one of its scans.
const Eigen::Isometry3d& poseIn(const ScanCluster& cluster, Index scan);

/// The cluster of a scan, which is in one.
Index clusterOf(const std::vector<ScanCluster>& clusters, Index scan);

/// Adds the scans of the second cluster.
void append(ScanCluster& first, const ScanCluster& second, const Eigen::Isometry3d& T_first_second);

/// The part of a cluster whose scans are listed, and the rest; the frame stays.
std::pair<ScanCluster, ScanCluster> divide(const ScanCluster& cluster, const std::vector<Index>& listed);

/// Makes the listed scans of one of the clusters a cluster of their own, which stands last, refused there.
void partCluster(std::vector<ScanCluster>& clusters, Index at, const std::vector<Index>& listed,
                 const Refusal& refusal);

/// Largest first.
/// @param first of those that are sorted; the ones before stay
void sortBySize(std::vector<ScanCluster>& clusters, Index first);

/// Where a scan is.
struct ClusterPlace {
  Index cluster = 0, position = 0;
};

/// Place of each scan, {0, 0} for those in no cluster.
std::vector<ClusterPlace> placesOf(const std::vector<ScanCluster>& clusters, Index scan_count);
} // namespace fresco::registration
