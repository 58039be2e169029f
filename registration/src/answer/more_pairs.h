// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/alignment_state.h"
#include "pair/pair_ranking.h"
namespace fresco::registration {
/// Brings scans that were just prepared into the state in which alignGlobally() left them.
void restoreScans(const AlignmentInput& input, const GlobalAlignment& alignment, int threads);

/// Aligns pairs, a < b, that alignGlobally() did not try, and adds them to those that it did.
void alignMore(const AlignmentInput& input, const ScanRegistrationOptions& options,
               const std::vector<RankedPair>& asked, std::vector<PairAlignment>& pairs);
} // namespace fresco::registration
