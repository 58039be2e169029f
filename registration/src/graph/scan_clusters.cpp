// SPDX-License-Identifier: BSD-3-Clause
#include "graph/scan_clusters.h"
#include <algorithm>
namespace fresco::registration {
bool contains(const ScanCluster& cluster, Index scan)
{
  return positionOf(cluster, scan) < static_cast<Index>(cluster.scans.size());
}

Index positionOf(const ScanCluster& cluster, Index scan)
{
  return std::find(cluster.scans.begin(), cluster.scans.end(), scan) - cluster.scans.begin();
}

const Eigen::Isometry3d& poseIn(const ScanCluster& cluster, Index scan)
{
  return cluster.poses[positionOf(cluster, scan)];
}

Index clusterOf(const std::vector<ScanCluster>& clusters, Index scan)
{
  return std::find_if(clusters.begin(), clusters.end(), [&](const auto& c) { return contains(c, scan); }) -
         clusters.begin();
}

void append(ScanCluster& first, const ScanCluster& second, const Eigen::Isometry3d& T_first_second)
{
  for (std::size_t k = 0; k < second.scans.size(); ++k) {
    first.scans.push_back(second.scans[k]);
    first.poses.push_back(T_first_second * second.poses[k]);
  }
}

std::pair<ScanCluster, ScanCluster> divide(const ScanCluster& cluster, const std::vector<Index>& listed)
{
  std::pair<ScanCluster, ScanCluster> sides;
  for (std::size_t k = 0; k < cluster.scans.size(); ++k) {
    const bool in = std::find(listed.begin(), listed.end(), cluster.scans[k]) != listed.end();
    ScanCluster& side = in ? sides.first : sides.second;
    side.scans.push_back(cluster.scans[k]);
    side.poses.push_back(cluster.poses[k]);
  }
  return sides;
}

void partCluster(std::vector<ScanCluster>& clusters, Index at, const std::vector<Index>& listed, const Refusal& refusal)
{
  auto [part, rest] = divide(clusters[at], listed);
  part.refusal = refusal;
  rest.refusal = clusters[at].refusal;
  clusters[at] = rest;
  clusters.push_back(part);
}

void sortBySize(std::vector<ScanCluster>& clusters, Index first)
{
  std::stable_sort(clusters.begin() + first, clusters.end(),
                   [](const auto& x, const auto& y) { return x.scans.size() > y.scans.size(); });
}

std::vector<ClusterPlace> placesOf(const std::vector<ScanCluster>& clusters, Index scan_count)
{
  std::vector<ClusterPlace> places(scan_count);
  for (std::size_t c = 0; c < clusters.size(); ++c)
    for (std::size_t k = 0; k < clusters[c].scans.size(); ++k)
      places[clusters[c].scans[k]] = {static_cast<Index>(c), static_cast<Index>(k)};
  return places;
}
} // namespace fresco::registration
