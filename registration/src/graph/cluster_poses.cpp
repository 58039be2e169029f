// SPDX-License-Identifier: BSD-3-Clause
#include "graph/cluster_poses.h"
#include <algorithm>
#include <fresco/registration/core/pose_graph.h>
namespace fresco::registration {
namespace {
// What all pairs between the cluster's scans say of poses near those it has.
PoseEdges edgesOf(const GraphInput& input, const ScanCluster& cluster, const PoseGraphOptions& options)
{
  constexpr double edge_reach = 6.0; // tolerances between a pair and the poses of its cluster: beyond, it is wrong
  const Index n = cluster.scans.size();
  PoseEdges edges;
  for (const PairAlignment& pair : input.pairs) {
    const Index a = positionOf(cluster, pair.a), b = positionOf(cluster, pair.b);
    if (a == n || b == n)
      continue;
    const Eigen::Isometry3d T = cluster.poses[a].inverse() * cluster.poses[b];
    for (const VerifiedHypothesis& hypothesis : pair.hypotheses)
      if (poseDistance(T, hypothesis.T_a_b, options.size) < edge_reach * options.tolerance)
        edges.push_back({a, b, hypothesis.T_a_b, hypothesis.support});
  }
  return edges;
}

void refine(const GraphInput& input, const ScanCluster& known, ScanCluster& cluster, int threads)
{
  ScanPointers scans;
  JointOptions options;
  options.max_distance = input.options.tolerance;
  options.min_overlap = 0.1f;
  options.samples = 1500; // of thousands: centimetres suffice
  options.first_level = check_level;
  options.last_level = check_level;
  options.max_iterations = 20;
  options.threads = threads;
  for (const Index scan : cluster.scans) {
    scans.push_back(&input.scans[scan]);
    if (!known.scans.empty())
      options.fixed.push_back(contains(known, scan));
  }
  cluster.poses = refineJointly(scans, cluster.poses, options, {}).poses;
}
} // namespace

void closeLoops(const GraphInput& input, const ScanCluster& known, ScanCluster& cluster)
{
  PoseGraphOptions options;
  options.size = input.scans[cluster.scans[0]].size;
  options.tolerance = input.options.tolerance;
  for (const Index scan : cluster.scans)
    options.fixed.push_back(contains(known, scan));
  if (std::find(options.fixed.begin(), options.fixed.end(), 1) == options.fixed.end())
    options.fixed[0] = 1;
  cluster.poses = optimizePoseGraph(cluster.poses, edgesOf(input, cluster, options), options);
}

void settle(const GraphInput& input, const ScanCluster& known, ScanCluster& cluster)
{
  if (cluster.scans.size() < 2)
    return;
  closeLoops(input, known, cluster);
  refineCluster(input, known, cluster);
}

void refineCluster(const GraphInput& input, const ScanCluster& known, ScanCluster& cluster)
{
  refine(input, known, cluster, input.options.threads);
}

Eigen::Isometry3d settledPose(const GraphInput& input, const ScanCluster& cluster, const ScanCluster& moving,
                              const Eigen::Isometry3d& T)
{
  ScanCluster both;
  append(both, moving, T);
  append(both, cluster, Eigen::Isometry3d::Identity());
  refine(input, cluster, both, 1);
  return both.poses[0] * moving.poses[0].inverse();
}
} // namespace fresco::registration
