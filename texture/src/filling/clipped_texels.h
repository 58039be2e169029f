// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "painting/atlas_paint.h"
namespace fresco::texture {
/// P, whether a patch is painted from a view that is overexposed there: its light may have been any brighter.
std::vector<char> clippedPatches(const PaintScene& scene, const Candidates& candidates);

/// Overexposed texels continue the surface around them where that is brighter than what the photograph says at least.
/// @param colors  3x3P, 0..255, of the patches' corners: diffused from patches that are not clipped
void continueClipped(const PaintScene& scene, const PaintSources& sources, const std::vector<char>& clipped,
                     const Points& colors, std::vector<Image>& atlases);
} // namespace fresco::texture
