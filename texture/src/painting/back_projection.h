// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "painting/atlas_paint.h"
namespace fresco::texture {
/// Makes the texture such that all photographs look as taken of it, not only the one that each patch was painted from:
/// each is predicted from the texels, a pixel as their mean over its area. The residual is projected back to the texels
/// that the pixel covers; better views weigh more. Irani & Peleg 1991, "Improving Resolution by Image Registration".
/// Undoes the blur of interpolation, averages noise, and lets steps between views fade; needs cameras
/// that agree to a fraction of a pixel.
/// @param rounds over all photographs, >= 0
void backProject(const PaintScene& scene, const PaintSources& sources, int rounds, std::vector<Image>& atlases);
} // namespace fresco::texture
