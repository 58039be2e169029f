// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "painting/atlas_paint.h"
#include "views/outline_mask.h"
namespace fresco::texture {
/// What decides where texels behind outlines take their colours from.
struct OutlineSources {
  const std::vector<Projector>& views;
  const Candidates& candidates;
  const std::vector<float>& penalties; ///< octaves, of each candidate
  const Blend& blend;
  const std::vector<OutlineMask>& masks; ///< of the views
};

/// Texels that the photographs meant for them show mixed with what stands before the surface.
struct OutlineTexels {
  std::vector<std::vector<PatchTexel>> by_view; ///< to be taken from that view alone, which shows them clean
  std::vector<PatchTexel> unknown;              ///< clean in no view
  std::vector<int> hidden;                      ///< patches with no other texels: they are not seen
};

OutlineTexels findOutlineTexels(const PaintScene& scene, const OutlineSources& sources);

/// Unknown texels continue the colours around them within their chart; they are marked in the masks.
void fillUnknown(const PaintScene& scene, const std::vector<PatchTexel>& unknown, std::vector<Image>& atlases,
                 std::vector<Image>& masks);
} // namespace fresco::texture
