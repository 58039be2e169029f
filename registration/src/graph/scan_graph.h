// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/pair_evidence.h"
#include "graph/scan_clusters.h"
namespace fresco::registration {
/// Where a cluster may be in another one, as their floor plans say.
struct PlanPlace {
  Index a = 0, b = 0;      ///< a scan of either
  Eigen::Isometry3d T_a_b; ///< working frames
};
using PlanPlaces = std::vector<PlanPlace, Eigen::aligned_allocator<PlanPlace>>;

struct ScanGraph {
  std::vector<ScanCluster> clusters; ///< every usable scan in one of them, largest first, but `known` before all
  PlanPlaces places = {};            ///< of clusters as wholes, which decided nothing
  std::vector<std::vector<Index>> parts = {}; ///< scans of clusters that were joined to larger ones
};

struct GraphOptions {
  float max_violation = 0.04f;
  float tolerance = 0.f; ///< of agreement between chains of poses, length
  int threads = 0;
};

/// What graphs are made of, and what is usual among all pairs.
struct GraphInput {
  /// Scans and pairs have to outlive it.
  GraphInput(const std::vector<PreparedScan>& scans, const std::vector<PairAlignment>& pairs,
             const GraphOptions& options);
  const std::vector<PreparedScan>& scans;
  const std::vector<PairAlignment>& pairs;
  std::vector<std::vector<const PairAlignment*>> pairs_of; ///< per scan
  GraphOptions options;
  double least_color, usual_violation, most_violation; ///< see leastColor(), usualViolation(), mostViolation()
};

/// Every scan without a problem alone, but the known ones, which come first.
std::vector<ScanCluster> startingClusters(const GraphInput& input, const ScanCluster& known);

/// Joins scans to clusters by the relative poses of pairs, the best first. Two clusters are joined only if no scan of
/// one lies in space that a scan of the other saw through, but for the little that all of several together allow. Of an
/// ambiguous pair a hypothesis is used only if it is the one that the clusters' other scans do not contradict. Scans
/// without a problem take part.
/// @param known scans that already share a frame; may be empty
ScanGraph buildScanGraph(const GraphInput& input, const ScanCluster& known);
} // namespace fresco::registration
