// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "pair/pair_verification.h"
#include "scan/scan_features.h"
#include <fresco/registration/core/sc2_pcr.h>
namespace fresco::registration {
constexpr double alias_distance = 0.5; ///< of a scan's size: nearer places that look alike are one place
constexpr double alias_color = 0.6;    ///< correlation of two places: below, their colours differ more than light does

/// Of a verified pose of a scan on itself.
ScanAlias toAlias(const VerifiedHypothesis& own);

/// Motions other than the identity that map a part of a scan onto another part of it: it saw two places that look
/// alike, such as the next bay of a corridor. Where there is such a motion S, a pose T of another scan has the
/// alternative S T, and only measurement can tell which is right. None without free space or of a narrow view.
ScanAliases findAliases(const PreparedScan& scan, const ScanFeatures& features);

/// Adds those of `more` of which the scan does not know as much.
/// @param size of the scan, length
void addAliases(const ScanAliases& more, double size, ScanAliases& aliases);
} // namespace fresco::registration
