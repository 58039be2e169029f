// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "painting/atlas_paint.h"
namespace fresco::texture {
/// What is painted of a mesh for good, where it is a tile with its surroundings.
struct PaintedPart {
  Index faces, patches;                ///< the first ones
  int blend_rounds = 0;                ///< see BlendOptions
  BorderOffsets* border = nullptr;     ///< see BlendOptions
  const Points* fill_colors = nullptr; ///< 3xP, of patches around that are painted; -1: not known. Null: no tile
  const std::vector<OutlineMask>* outlines = nullptr; ///< in place of those of the visible surface
};

/// 3xP, of seen patches, and of unseen ones around a tile that are known; (-1,-1,-1) for the others.
Points knownColors(const PaintScene& scene, const PaintedPart& part, const std::vector<Image>& atlases);

/// Leaves out the atlases of what lies around a tile. @return 3xP, colours of its own patches
Points takeOwn(const PaintScene& scene, const PaintedPart& part, TextureResult& result);
} // namespace fresco::texture
