// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "painting/atlas_paint.h"
namespace fresco::texture {
/// Texels that the photographs meant for them show mixed with what stands before the surface.
struct OutlineTexels {
  std::vector<std::vector<PatchTexel>> by_view; ///< to be taken from that view alone, which shows them clean
  std::vector<PatchTexel> unknown;              ///< clean in no view
  std::vector<int> hidden;                      ///< patches with no other texels: they are not seen
};

OutlineTexels findOutlineTexels(const PaintScene& scene, const PaintSources& sources);

/// Unknown texels continue the colours around them within their chart; they are marked in the masks.
void fillUnknown(const PaintScene& scene, const std::vector<PatchTexel>& unknown, std::vector<Image>& atlases,
                 std::vector<Image>& masks);
} // namespace fresco::texture
