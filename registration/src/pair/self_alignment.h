// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "pair/pair_alignment.h"
namespace fresco::registration {
/// Motions other than the identity that map a part of a scan onto another part of it: it saw two places that look
/// alike, such as the next bay of a corridor. Where there is such a motion S, a pose T of another scan has the
/// alternative S T, and only measurement can tell which is right. None without free space or of a narrow view.
ScanAliases findAliases(const PreparedScan& scan, const ScanFeatures& features);

/// The same, found by its floor plan.
ScanAliases findAliasesByPlan(const PlannedScan& scan);

/// Adds those of `more` of which the scan does not know as much.
/// @param size of the scan, length
void addAliases(const ScanAliases& more, double size, ScanAliases& aliases);
} // namespace fresco::registration
