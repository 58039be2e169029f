// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "evidence/frame_evidence.h"
#include "graph/scan_graph.h"
#include <map>
#include <unordered_map>
namespace fresco::registration {
/// A relative pose of two scans that something proposes.
struct ProposedPlace {
  Index a = 0, b = 0;
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();
};
using ProposedPlaces = std::vector<ProposedPlace, Eigen::aligned_allocator<ProposedPlace>>;

inline ScanCluster frameOf(const ProposedPlace& place)
{
  return {{place.a, place.b}, {Eigen::Isometry3d::Identity(), place.T_a_b}};
}

/// Log-odds of frames. What a scan says of another one at a pose is found once, some millisecond, and remembered, some 2.5 kB.
class FrameJudge {
public:
  /// @param scans after prepareManySearches()
  /// @param places that are proposed: they tell what agreement of a room is worth, see EvidenceModel::roomBound()
  FrameJudge(const std::vector<PreparedScan>& scans, const ProposedPlaces& places, const EvidenceModel& model,
             int threads);

  /// Log-odds of each frame, against all of its scans being elsewhere; 0 for a scan alone. Depends on the relative poses
  /// alone, rounded to a quarter of a voxel.
  std::vector<double> logOdds(const std::vector<ScanCluster>& frames);
  double logOdds(const ScanCluster& frame) { return logOdds(std::vector<ScanCluster>{frame})[0]; }

  /// What the others say of one of the scans.
  ScanEvidence evidenceOf(const ScanCluster& frame, std::size_t member);

  const std::vector<PreparedScan>& scans() const { return scans_; }
  double roomBound() const { return room_bound_; } ///< see EvidenceModel::roomBound()

private:
  struct View {
    Index seer, seen;
    std::array<int, 6> place; ///< rotation vector, translation
    bool operator==(const View& other) const
    {
      return seer == other.seer && seen == other.seen && place == other.place;
    }
  };
  struct Hash {
    std::size_t operator()(const View& view) const;
  };
  View viewOf(const ScanCluster& frame, std::size_t seer, std::size_t seen) const;
  PatchVotes find(const View& view) const;
  std::vector<int> keyOf(const ScanCluster& frame) const;
  void remember(const std::vector<ScanCluster>& frames);
  ScanEvidence recall(const ScanCluster& frame, std::size_t member) const;
  double recallLogOdds(const ScanCluster& frame) const;

  const std::vector<PreparedScan>& scans_;
  const EvidenceModel& model_;
  int threads_;
  double grain_ = 0.0; ///< length
  double size_ = 0.0;  ///< that makes rotations lengths
  double room_bound_ = 0.0;
  std::vector<ScanPatches> patches_;
  std::unordered_map<View, PatchVotes, Hash> votes_;
  std::map<std::vector<int>, double> odds_; ///< of frames
};
} // namespace fresco::registration
