// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "pair/pair_alignment.h"
namespace fresco::registration {
/// Of the overlap, or of the points that are confirmed, at another place: less, and chance explains it. Of equal rooms, the
/// wrong one may be seen best.
constexpr double chance_share = 0.4;

constexpr Index fewest_pairs = 2; ///< that tell something: one may be wrong itself

/// Whether a pose is the best of its pair, hardly by chance, and nothing that the two see contradicts it.
bool isSound(const PairAlignment& pair, const VerifiedHypothesis& hypothesis);

/// Where most pairs agree well in colour, one below this correlation is a look-alike; else -1.
double leastColor(const std::vector<PairAlignment>& pairs);

/// Where most pairs contradict free space hardly at all, a pair above this is a look-alike or has seen a change.
double usualViolation(const std::vector<PairAlignment>& pairs);

/// Of two scans of one state of a place, 0..1: what moves or is misread, panes for one.
/// @param limit it is no larger
double mostViolation(const std::vector<PairAlignment>& pairs, double limit);

/// Two scans that see one room see all of it through the same air: the little that contradicts tells it from its twin.
bool contradictsOneRoom(const PairCheck& check, double usual_violation);
} // namespace fresco::registration
