// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "pair/pair_alignment.h"
namespace fresco::registration {
/// Scans whose viewpoint must be wrong, since their free space contradicts what many features agree on. A viewpoint that
/// a file gives for a scan of wide view, or that its points show, is never held wrong: rooms that look alike are the
/// likelier reason.
/// @return per scan
std::vector<char> wrongViewpoints(const std::vector<PreparedScan>& scans, const std::vector<PairAlignment>& pairs,
                                  double max_violation);
} // namespace fresco::registration
