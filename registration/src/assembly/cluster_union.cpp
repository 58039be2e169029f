// SPDX-License-Identifier: BSD-3-Clause
#include "assembly/cluster_union.h"
#include <algorithm>
namespace fresco::registration {
namespace {
// A cluster that shares scans with the one that is added.
struct Link {
  std::size_t cluster;
  Eigen::Isometry3d T; // its frame from that of the added one
  std::vector<Index> shared;
};
using Links = std::vector<Link, Eigen::aligned_allocator<Link>>;

class ClusterUnion {
public:
  ClusterUnion(const GraphInput& input, const FreeSpaceJudge& judge) : input_(input), judge_(judge) {}

  std::vector<JoinedCluster> run(const ScanGraph& first, const ScanGraph& second);

private:
  void add(const ScanCluster& cluster);
  bool has(Index scan) const
  {
    return std::any_of(clusters_.begin(), clusters_.end(),
                       [scan](const JoinedCluster& joined) { return contains(joined.cluster, scan); });
  }
  Link linkTo(std::size_t cluster, const ScanCluster& added) const;
  bool agrees(const Link& link, const ScanCluster& added) const;
  bool isPossible(const Link& link, const Links& others, const ScanCluster& added) const;
  void unite(const Links& links, const ScanCluster& added);

  const GraphInput& input_;
  const FreeSpaceJudge& judge_;
  std::vector<JoinedCluster> clusters_;
};

// By the first scan that they share.
Link ClusterUnion::linkTo(std::size_t cluster, const ScanCluster& added) const
{
  const ScanCluster& known = clusters_[cluster].cluster;
  Link link{cluster, Eigen::Isometry3d::Identity(), {}};
  for (const Index scan : known.scans)
    if (contains(added, scan))
      link.shared.push_back(scan);
  if (!link.shared.empty())
    link.T = poseIn(known, link.shared[0]) * poseIn(added, link.shared[0]).inverse();
  return link;
}

// Whether all scans that they share are where the link says.
bool ClusterUnion::agrees(const Link& link, const ScanCluster& added) const
{
  const ScanCluster& known = clusters_[link.cluster].cluster;
  return std::all_of(link.shared.begin(), link.shared.end(), [&](Index scan) {
    return poseDistance(link.T * poseIn(added, scan), poseIn(known, scan), input_.scans[scan].size) <
           3.0 * input_.options.tolerance;
  });
}

// Whether free space allows what a link brings together.
bool ClusterUnion::isPossible(const Link& link, const Links& others, const ScanCluster& added) const
{
  const auto contradicts = [&](const ScanCluster& first, const ScanCluster& second, const Eigen::Isometry3d& T) {
    return !first.scans.empty() && !second.scans.empty() && isContradicted(judge_.judge(first, second, T));
  };
  const ScanCluster &known = clusters_[link.cluster].cluster, rest = divide(added, link.shared).second;
  return !contradicts(known, rest, link.T) && std::none_of(others.begin(), others.end(), [&](const Link& other) {
    return contradicts(known, clusters_[other.cluster].cluster, link.T * other.T.inverse());
  });
}

// The frame of the first linked cluster stays.
void ClusterUnion::unite(const Links& links, const ScanCluster& added)
{
  JoinedCluster united = clusters_[links[0].cluster];
  united.parts.push_back(added.scans);
  for (std::size_t k = 1; k < links.size(); ++k) {
    const JoinedCluster& other = clusters_[links[k].cluster];
    append(united.cluster, other.cluster, links[0].T * links[k].T.inverse());
    united.parts.insert(united.parts.end(), other.parts.begin(), other.parts.end());
  }
  append(united.cluster, divide(added, united.cluster.scans).second, links[0].T);
  clusters_[links[0].cluster] = std::move(united);
  for (std::size_t k = links.size(); k-- > 1;) // in order
    clusters_.erase(clusters_.begin() + links[k].cluster);
}

void ClusterUnion::add(const ScanCluster& cluster)
{
  Links links;
  for (std::size_t c = 0; c < clusters_.size(); ++c) {
    const Link link = linkTo(c, cluster);
    if (link.shared.empty())
      continue;
    if (!agrees(link, cluster) || !isPossible(link, links, cluster))
      return;
    links.push_back(link);
  }
  if (!links.empty())
    unite(links, cluster);
}

// What only one of both graphs brings may be wrong alone.
void addSingleParts(const ScanGraph& first, const ScanGraph& second, JoinedCluster& joined)
{
  const auto brings = [](const ScanGraph& graph, Index scan) {
    return std::any_of(graph.clusters.begin(), graph.clusters.end(), [scan](const ScanCluster& cluster) {
      return cluster.scans.size() > 1 && contains(cluster, scan);
    });
  };
  for (const Index scan : joined.cluster.scans)
    if (!(brings(first, scan) && brings(second, scan)))
      joined.parts.push_back({scan});
}

std::vector<JoinedCluster> ClusterUnion::run(const ScanGraph& first, const ScanGraph& second)
{
  for (const ScanCluster& cluster : first.clusters)
    if (cluster.scans.size() > 1)
      clusters_.push_back({cluster, {cluster.scans}});
  for (const ScanCluster& cluster : second.clusters)
    if (cluster.scans.size() > 1)
      add(cluster);
  for (JoinedCluster& joined : clusters_)
    addSingleParts(first, second, joined);
  for (const ScanCluster& cluster : first.clusters)
    if (cluster.scans.size() == 1 && !has(cluster.scans[0]))
      clusters_.push_back({cluster, {}});
  return std::move(clusters_);
}
} // namespace

std::vector<JoinedCluster> uniteClusters(const GraphInput& input, const FreeSpaceJudge& judge, const ScanGraph& first,
                                         const ScanGraph& second)
{
  return ClusterUnion(input, judge).run(first, second);
}
} // namespace fresco::registration
