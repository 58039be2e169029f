// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "pair/pair_alignment.h"
namespace fresco::registration {
/// Motions other than the identity that map a part of a scan onto another part of it: it saw two places that look
/// alike, such as the next bay of a corridor. Where there is such a motion S, a pose T of another scan has the
/// alternative S T, and only measurement can tell which is right. None without free space or of
/// a narrow view.
SelfMotions findSelfMotions(const PreparedScan& scan, const ScanFeatures& features);

/// A second place that one scan glimpsed, as through two doors, counts for all scans of the first: each scan receives
/// the glimpsed motions of those it overlaps largely.
void shareGlimpses(std::vector<PreparedScan>& scans, const std::vector<PairAlignment>& pairs);
} // namespace fresco::registration
