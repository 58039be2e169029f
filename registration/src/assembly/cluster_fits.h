// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/free_space_evidence.h"
#include "scan/lists.h"
#include <algorithm>
#include <map>
#include <utility>
namespace fresco::registration {
/// A place of one cluster in another.
struct ClusterFit {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity(); ///< frame of the first from that of the second
  Index pairs = 0;                                     ///< that lead to it
  double overlap = 0.0;                                ///< the largest of theirs, 0..1
  bool sound = false;   ///< it is the best of one of them, and nothing contradicts it there
  bool certain = false; ///< likewise, and that pair has no other
  FreeSpaceEvidence evidence;
};
using ClusterFits = std::vector<ClusterFit, Eigen::aligned_allocator<ClusterFit>>;

/// The place of the first cluster in the second. @param fit a ClusterFit or what has its T
template <typename Fit>
Fit reversed(Fit fit)
{
  fit.T = fit.T.inverse();
  return fit;
}

/// Whether two clusters may be joined by it.
bool isJoinable(const ClusterFit& fit);

/// Whether another place is seen well enough to make one doubtful. Overlap hardly counts: of equal rooms, the wrong one
/// may be seen best.
bool isSeenAsWell(const ClusterFit& other, const ClusterFit& fit);

/// Whether one place makes another doubtful. @param unit see FreeSpaceJudge
bool rivals(const ClusterFit& other, const ClusterFit& fit, double unit);

constexpr double near_tolerances = 3.0; ///< between two places that are the same, see ClusterFitter::isSame()

/// Finds places of clusters in each other by the hypotheses of pairs of their scans.
class ClusterFitter {
public:
  /// Both have to outlive it.
  ClusterFitter(const GraphInput& input, const FreeSpaceJudge& judge) : input_(input), judge_(judge) {}

  /// All that pairs lead to, distinct. Their evidence is not judged.
  ClusterFits rough(const ScanCluster& first, const ScanCluster& second) const;

  /// Those that free space does not contradict.
  ClusterFits uncontradicted(const ScanCluster& first, const ScanCluster& second, const ClusterFits& rough) const;

  /// Of all that pairs lead to, those that free space does not contradict and that count: by which the two could be
  /// joined, their rivals, and those that a pair is certain of.
  ClusterFits find(const ScanCluster& first, const ScanCluster& second) const;

  /// Whether a cluster is at the same place with either of two motions. @param tolerances see GraphOptions
  bool isSame(const ScanCluster& moving, const Eigen::Isometry3d& T, const Eigen::Isometry3d& other,
              double tolerances) const;

private:
  void add(const ScanCluster& second, const ClusterFit& fit, ClusterFits& fits) const;

  const GraphInput& input_;
  const FreeSpaceJudge& judge_;
};

/// Places of all groups of scans in each other, found once for each pair of groups.
/// @tparam Fits list of places, each with T, the frame of one group from that of the other
template <typename Fits>
class GroupFits {
public:
  /// @param groups with an id that changes whenever their scans do
  /// @param find the places of a second group in a first one, whose id is lower; called from several threads
  template <typename Groups, typename Find>
  void findNew(const Groups& groups, int threads, const Find& find)
  {
    using Group = typename Groups::value_type;
    std::vector<std::pair<const Group*, const Group*>> fresh;
    for (auto i = groups.begin(); i != groups.end(); ++i)
      for (auto k = std::next(i); k != groups.end(); ++k) {
        const auto [first, second] = std::minmax(*i, *k, [](const Group& x, const Group& y) { return x.id < y.id; });
        if (fits_.find({first.id, second.id}) == fits_.end())
          fresh.push_back({&first, &second});
      }
    std::vector<Fits> found =
        mapTasks(fresh.size(), threads, [&](Index k) { return find(*fresh[k].first, *fresh[k].second); });
    for (std::size_t k = 0; k < fresh.size(); ++k)
      fits_[{fresh[k].first->id, fresh[k].second->id}] = std::move(found[k]);
  }

  /// Of the second in the first, by their ids.
  Fits of(Index first, Index second) const
  {
    Fits fits = fits_.at({std::min(first, second), std::max(first, second)});
    if (first > second)
      for (auto& fit : fits)
        fit.T = fit.T.inverse();
    return fits;
  }

private:
  std::map<std::pair<Index, Index>, Fits> fits_;
};
} // namespace fresco::registration
