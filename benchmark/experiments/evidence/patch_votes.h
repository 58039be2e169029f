// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "evidence/scan_patches.h"
namespace fresco::registration {
/// What other scans say of a patch: nothing, or one or both of these. Votes of several scans are joined by `or`: each patch
/// votes once, however many scans see it.
using PatchVote = unsigned char;
constexpr PatchVote confirmed_vote = 1;    ///< a surface of like normal was measured there
constexpr PatchVote contradicted_vote = 2; ///< the place was seen through
constexpr PatchVote compared_vote = 4;     ///< a surface was measured there, like it or not
using PatchVotes = std::vector<PatchVote>;

/// What one scan says of the patches of another.
/// @param seer after prepareManySearches()
PatchVotes votesOf(const PreparedScan& seer, const ScanPatches& seen, const Eigen::Isometry3d& T_seer_seen);

/// Sizes of the connected groups of contradicted patches: a person, an open door, a wall each contradict once.
std::vector<Index> contradictedGroups(const ScanPatches& patches, const PatchVotes& votes);
} // namespace fresco::registration
