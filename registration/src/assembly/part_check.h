// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "assembly/cluster_fits.h"
namespace fresco::registration {
/// Scans of a cluster, and its others.
struct ClusterPart {
  const ScanCluster &part, &rest;
  FreeSpaceEvidence here; ///< of the part in the rest
};

/// Tells whether a part of a cluster may be elsewhere. Agreement hardly counts: of equal rooms, the wrong one may be seen
/// best.
class PartCheck {
public:
  /// Both have to outlive it.
  PartCheck(const FreeSpaceJudge& judge, const ClusterFitter& fitter) : judge_(judge), fitter_(fitter) {}

  /// Whether free space contradicts where it is more than errors of poses explain.
  static bool isMisplaced(const ClusterPart& placed);

  /// What of a cluster still hangs together by surfaces that two scans see alike.
  std::vector<ScanCluster> heldTogether(const ScanCluster& cluster) const;

  /// Whether what two pairs, a certain or a good one say of a part leads to another place in its cluster, which free
  /// space contradicts no more.
  bool fitsElsewhere(const ClusterPart& placed) const;

  /// Whether it may as well be where one of the motions leads it.
  bool mayBeMoved(const ClusterPart& placed, const IsometryVector& motions) const;

  /// Whether another cluster has a certain place for a part, or a sound one where free space contradicts the part's own,
  /// and free space contradicts that cluster and the rest where this place leads to.
  bool isClaimed(const ScanCluster& claimer, const ClusterPart& placed) const;

private:
  bool isUndecided(const FreeSpaceEvidence& here, const FreeSpaceEvidence& there, bool certain) const;

  const FreeSpaceJudge& judge_;
  const ClusterFitter& fitter_;
};
} // namespace fresco::registration
