// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "mixed_pixels/mixed_pixel_features.h"
#include <functional>
namespace fresco::filters {
/// @param i position of a beam in its scan
using UseCandidate = std::function<void(Index i, const BeamSurroundings& around)>;
using UseLikely = std::function<void(Index i, const LikelyFigures& figures)>;

/// For each beam that has nearer and farther ones beside it and few that a surface could join it with. Different beams
/// at the same time.
void forVeilCandidates(const BeamScan& scan, const VeilOptions& options, const UseCandidate& use);

constexpr float least_likely = -6; ///< score of a beam that is worth a second look
/// For each of those beams that scores more than least_likely.
/// @param scores by position, of the others at most that; beams above 0 are left out in the second half of the figures
void forLikelyVeil(const BeamScan& scan, const VeilOptions& options, const std::vector<float>& scores,
                   const UseLikely& use);
} // namespace fresco::filters
