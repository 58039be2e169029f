// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan/scan_free_space.h"
#include "scan/thinning.h"
#include <fresco/registration/core/neighbor_search.h>
#include <fresco/search/nearest_grid.h>
#include <memory>
#include <string>
#include <vector>
namespace fresco::registration {
/// One scan at one resolution, in the scan's working frame.
struct ScanLevel : SurfacePoints {
  std::shared_ptr<const NearestGrid> grid; ///< for many searches, see prepareManySearches(); may be null
  PointBlocks blocks;                      ///< of the points, for many judgements; likewise, may be empty
  std::vector<Index> samples;              ///< see normalSpaceOrder()
  std::vector<char> maybe_person;          ///< N, see findPeople(); empty = not looked for

  /// To be called before searches: a caller's own search holds the points of one level at a time.
  void prepareSearch() const;
  /// The nearest point closer than `max_distance`; index -1 where there is none.
  Neighbor nearest(const Eigen::Vector3f& query, float max_distance) const;
};

/// A motion other than the identity that maps a part of a scan onto another part of it: two places that look alike.
struct ScanAlias {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity(); ///< in the scan's working frame
  bool certain = false; ///< nothing that the scan saw speaks against it; else it is worth a try
  bool partial = false; ///< whether little of the second place was seen, as through two doors
};
using ScanAliases = std::vector<ScanAlias, Eigen::aligned_allocator<ScanAlias>>;

/// What registration keeps of a scan.
struct PreparedScan {
  std::string problem;                              ///< why it cannot be registered; empty = it can
  Index duplicate_of = -1;                          ///< the scan that has the same points; -1 = none
  Eigen::Vector3d center = Eigen::Vector3d::Zero(); ///< scan = center + working
  bool viewpoint_given = false;                     ///< its file tells where it was seen from
  bool viewpoint_found = false;                     ///< its points do, see findViewpoint()
  bool blind = false;                               ///< it saw a place all around, and nothing tells from where
  std::string viewpoint_problem;                    ///< why its free space is not used; empty = it is
  double size = 0.0;                                ///< median distance of its points from where they were seen, length
  bool oriented = false;                            ///< normals point to the free side; else their sign means nothing
  std::vector<ScanLevel> levels;                    ///< coarse to fine
  ScanFreeSpace free_space;                         ///< empty unless oriented
  bool spares_doubtful = false;                     ///< people and what was seen through only nearby contradict nothing
  ScanAliases aliases;                              ///< found by findAliases()
};

/// Level on which two scans are compared: fine enough for furniture, coarser than the errors of a measured pose.
constexpr int check_level = level_count - 2;

constexpr float final_distance = 2.f; ///< voxels of a level: correspondences at its end, neighbours of the right cell

/// Whether it saw enough, 0.4 of all directions, to rule out wrong places of others.
inline bool sawAround(const PreparedScan& scan)
{
  constexpr double least_coverage = 0.4;
  return scan.free_space.coverage() >= least_coverage;
}

/// Number of scans that can be registered.
Index countUsable(const std::vector<PreparedScan>& scans);

/// For a scan whose viewpoint turned out wrong: no free space, normals towards the middle of the scan.
void distrustViewpoint(PreparedScan& scan, const std::string& reason);

/// Makes searches within two voxels faster in a level that has a tree.
void prepareManySearches(ScanLevel& level);

/// Makes searches and questions to free space faster in a scan that is compared with others: some 0.1 s and 2 MB.
void prepareManySearches(PreparedScan& scan);

/// @param search the caller's own search for neighbours; null = PointTree
PreparedScan prepareScan(const PointSet& scan, const Thinning& thinning, int threads,
                         const std::shared_ptr<NeighborSearch>& search = nullptr);
} // namespace fresco::registration
