// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/alignment_state.h"
namespace fresco::registration {
/// What hints join or split. The first cluster stays the first, and its frame that of the others' hints.
/// @param said a line for each hint that joins nothing: why, or that it is so already. What becomes of those that join is
///             known once all poses are refined: HintedJoin
void followHints(const AlignmentInput& input, const ScanRegistrationOptions& options, GlobalAlignment& alignment,
                 std::vector<std::string>& said);
} // namespace fresco::registration
