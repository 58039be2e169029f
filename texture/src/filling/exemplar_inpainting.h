// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "painting/atlas_paint.h"
namespace fresco::texture {
/// Gives unseen parts, coloured smoothly before, the fine structure of the seen surface around them: where a hole in a
/// chart is larger than a few texels, what differs from the smooth colours is synthesised from the seen texels of the
/// same chart near by. Holes without enough seen texels near by stay smooth.
/// @param masks 255 where unseen, as paintUnseen() writes them
/// @return texels filled
Index inpaintByExample(const PaintScene& scene, const std::vector<Image>& masks, std::vector<Image>& atlases);
} // namespace fresco::texture
