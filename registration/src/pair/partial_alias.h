// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "pair/pair_alignment.h"
namespace fresco::registration {
/// Aliases of which the scan saw little, such as an equal room through two doors: what is far fits to what is near, and
/// nothing contradicts it.
ScanAliases findPartialAliases(const PreparedScan& scan, const ScanFeatures& features, const Sc2PcrOptions& sc2_pcr);

/// A second place of which one scan saw little counts for all scans of the first: each scan receives the partial
/// aliases of those it overlaps largely. What one of them contradicts is dropped.
void sharePartialAliases(std::vector<PreparedScan>& scans, const std::vector<PairAlignment>& pairs);
} // namespace fresco::registration
