// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "evidence/patch_votes.h"
#include <array>
#include <fresco/core/rigid_motion.h>
namespace fresco::registration {
/// Bins of the sizes of contradicted groups: 1, 2..3, 4..7, ... patches; the last holds all larger ones.
constexpr int group_bins = 9;

/// What all others of a frame say of one room that a scan saw.
struct RoomAgreement {
  std::array<double, patch_kinds> confirmed{}; ///< patches, those also contradicted left out
  double compared = 0.0;                       ///< patches that were looked at
  double witnesses = 0.0; ///< shares of the confirmed patches, summed over the other scans: 1 = one of them saw all
  bool own = false;       ///< where the scanner stood
};

/// What all others of a frame say of a scan. It depends neither on their order nor on the frame.
struct ScanEvidence {
  std::vector<RoomAgreement> rooms;
  std::array<double, group_bins> contradicted{}; ///< groups, by size
  double comparisons = 0.0;                      ///< of patches with a surface of another scan
};

/// @param others votes of each other scan of the frame on the patches
ScanEvidence judge(const ScanPatches& patches, const std::vector<const PatchVotes*>& others);

/// The model that turns evidence into log-odds that the scans of a frame lie as its poses say. Its numbers are fitted by
/// benchmark/experiments/evidence_fit.py.
struct EvidenceModel {
  std::array<double, patch_kinds> agree;     ///< of a confirmed patch, by kind
  double room_base, room_slope;              ///< see roomBound()
  std::array<double, group_bins> contradict; ///< what a contradicted group costs, by size
  std::array<double, group_bins> stray;      ///< such groups in a comparison at right places: panes, edges
  double prior;                              ///< of each scan that joins a frame

  /// Log-odds of a frame.
  ///
  /// That two rooms are equal is one event of many patches: so agreement of a room saturates, and of n scans that saw it
  /// n - 1 agree with a first. Contradiction counts as far as it exceeds what right places have.
  /// @param scans of the frame
  /// @param most  that agreement of a room is worth, see roomBound()
  double logOdds(const std::vector<ScanEvidence>& scans, double most) const;

  /// The odds that a building does not repeat its rooms, from what is proposed for its scans: where the rooms of two scans
  /// agree nearly everywhere, wrong places are mostly refuted, unless there are equal rooms.
  /// @param pairs what the two scans of each proposed place say of each other
  double roomBound(const std::vector<std::array<ScanEvidence, 2>>& pairs) const;
};

const EvidenceModel& fittedModel();
} // namespace fresco::registration
