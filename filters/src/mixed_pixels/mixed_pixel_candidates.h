// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "mixed_pixels/mixed_pixel_features.h"
#include <functional>
namespace fresco::filters {
/// @param i position of a beam in its scan
using UseMixedPixelCandidate = std::function<void(Index i, const BeamSurroundings& around)>;
using UseSecondStage = std::function<void(Index i, const SecondStageFeatures& features)>;

/// For each beam that has nearer and farther ones beside it and few that a surface could join it with. Different beams
/// at the same time.
void forMixedPixelCandidates(const BeamScan& scan, const MixedPixelOptions& options, const UseMixedPixelCandidate& use);

constexpr float least_second_stage = -6; ///< score of a beam that the second network judges: one in 400
/// For each of those beams that scores more than least_second_stage.
/// @param scores by position, of the others at most that; beams above 0 are left out in the second half of the features
void forSecondStage(const BeamScan& scan, const MixedPixelOptions& options, const std::vector<float>& scores,
                    const UseSecondStage& use);
} // namespace fresco::filters
