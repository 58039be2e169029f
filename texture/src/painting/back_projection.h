// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "painting/atlas_paint.h"
namespace fresco::texture {
struct BackProjectionOptions {
  int rounds;                       ///< over all photographs, >= 0
  const std::vector<float>& errors; ///< of each view, pixels by which it is off; empty: not known, nothing is done
};

/// Makes the texture such that all photographs look as taken of it, not only the one that each patch was painted from:
/// each is predicted from the texels, a pixel as their mean over its area. The residual is projected back to the texels
/// that the pixel covers; better views weigh more. Irani & Peleg 1991, "Improving Resolution by Image Registration".
/// Undoes the blur of interpolation, averages noise, and lets steps between views fade. What a photograph shows otherwise
/// counts the less the more it is off from the others.
void backProject(const PaintScene& scene, const PaintSources& sources, const BackProjectionOptions& options,
                 std::vector<Image>& atlases);
} // namespace fresco::texture
