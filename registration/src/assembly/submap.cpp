// SPDX-License-Identifier: BSD-3-Clause
#include "assembly/submap.h"
#include "refinement/joint_refinement.h"
#include <algorithm>
#include <cmath>
#include <fresco/registration/core/surface_points.h>
namespace fresco::registration {
namespace {
// Of the levels of scans: plans are right to a voxel of the first, and coarser ones make what little holds slide.
constexpr int first_level = 1;

// All points of one level, in the frame of the cluster.
ScanLevel mergedLevel(const std::vector<PreparedScan>& scans, const ScanCluster& cluster, int k)
{
  ScanLevel merged;
  merged.voxel = scans[cluster.scans[0]].levels[k].voxel;
  Index count = 0;
  for (const Index scan : cluster.scans)
    count += scans[scan].levels[k].points.cols();
  merged.points.resize(3, count);
  merged.normals.resize(3, count);
  merged.surface_variation.resize(count);
  Index begin = 0;
  for (std::size_t i = 0; i < cluster.scans.size(); ++i) {
    const ScanLevel& level = scans[cluster.scans[i]].levels[k];
    const Eigen::Isometry3f T = cluster.poses[i].cast<float>();
    const Index n = level.points.cols();
    merged.points.middleCols(begin, n) = T * level.points;
    merged.normals.middleCols(begin, n) = T.linear() * level.normals;
    merged.surface_variation.segment(begin, n) = level.surface_variation;
    begin += n;
  }
  merged.tree = std::make_shared<PointTree>(merged.points, 1);
  prepareManySearches(merged);
  merged.samples = normalSpaceOrder(merged);
  return merged;
}

// Moves the origin of the plan to the middle of the cluster, and measures the plan.
void centerPlan(Submap& submap)
{
  const Points points = submap.frame.T_plan_scan * submap.surface.levels.front().points;
  const Eigen::Vector2f low = points.topRows<2>().rowwise().minCoeff();
  const Eigen::Vector2f high = points.topRows<2>().rowwise().maxCoeff();
  const Eigen::Vector2f middle = 0.5f * (low + high);
  const Eigen::Translation3f shift(-middle.x(), -middle.y(), 0.f);
  submap.frame.T_plan_scan = shift * submap.frame.T_plan_scan;
  submap.extent = (high - low).maxCoeff();
}
} // namespace

std::optional<Submap> makeSubmap(const std::vector<PreparedScan>& scans, const PlanFrames& frames,
                                 const ScanCluster& cluster)
{
  const auto framed =
      std::find_if(cluster.scans.begin(), cluster.scans.end(), [&](Index scan) { return frames[scan].has_value(); });
  if (framed == cluster.scans.end())
    return std::nullopt;
  Submap submap;
  submap.surface.size = scans[*framed].size;
  submap.surface.oriented = true;
  for (int k = first_level; k <= check_level; ++k)
    submap.surface.levels.push_back(mergedLevel(scans, cluster, k));
  submap.frame = *frames[*framed];
  const Eigen::Isometry3d& pose = cluster.poses[framed - cluster.scans.begin()];
  submap.frame.T_plan_scan = submap.frame.T_plan_scan * pose.inverse().cast<float>();
  centerPlan(submap);
  for (std::size_t i = 0; i < cluster.scans.size(); ++i)
    submap.placed.push_back({scans[cluster.scans[i]], submap.frame.T_plan_scan * cluster.poses[i].cast<float>()});
  return submap;
}

IsometryVector matchSubmaps(const Submap& first, const Submap& second, std::size_t most)
{
  // Cells enough that nothing of one reaches the other around the edge.
  const PlanGrid grid =
      makePlanGrid(0.5f * (first.frame.height + second.frame.height), first.extent + second.extent, 1024);
  const PlanSpectrum plan_first(drawFloorPlan(first.placed, grid), first.frame, grid);
  const PlanSpectrum plan_second(drawFloorPlan(second.placed, grid), second.frame, grid);
  IsometryVector places;
  for (const PoseHypothesis& place : matchPlans(plan_first, plan_second, most))
    places.push_back(place.T_a_b);
  return places;
}

Eigen::Isometry3d refineSubmap(const Submap& first, const Submap& second, const Eigen::Isometry3d& T)
{
  constexpr Index samples = 1500;
  return refinePair({first.surface, second.surface}, T, {0, check_level - first_level}, samples).poses[1];
}
} // namespace fresco::registration
