// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "charts/chart.h"
#include "painting/view_blend.h"
namespace fresco::texture {
/// What painting reads.
struct PaintScene {
  const PatchMesh& patches;
  const std::vector<Chart>& charts;
  const Eigen::VectorXi& face_chart; ///< F, -1 = none
  const Eigen::VectorXi& view;       ///< P, -1 = unseen
  const std::vector<int>& slots;     ///< P, number of the patch in its chart's texels, -1 = it has none
  int threads;

  const Chart* chartOf(Index patch) const ///< null = none
  {
    const int c = face_chart[patches.parent[patch]];
    return c < 0 ? nullptr : &charts[c];
  }
  /// Whether a patch has texels and is painted from photographs.
  bool isSeen(Index patch) const { return view[patch] >= 0 && slots[patch] >= 0; }
};

/// A texel of a patch, in its chart.
struct PatchTexel {
  int patch, x, y;
};

/// P, see PaintScene::slots.
std::vector<int> texelSlots(const std::vector<Chart>& charts, Index patches);

/// Whether the seen surface goes on straight beyond a side of the patch, the one from corner `side` to the next.
bool goesOn(const PaintScene& scene, Index patch, int side);

/// Where colours come from.
struct PaintSources {
  const std::vector<Projector>& views;
  const Points& gains; ///< 3xV, factor per view and channel
  const Blend& blend;
  PhotoStore& photos;
};

/// Fills the texels of the seen patches from their photographs.
void paintSeen(const PaintScene& scene, const PaintSources& sources, std::vector<Image>& atlases);

/// Fills these texels anew, each from one view alone.
/// @param by_view those of a patch one after the other
void paintTexels(const PaintScene& scene, const PaintSources& sources,
                 const std::vector<std::vector<PatchTexel>>& by_view, std::vector<Image>& atlases);

/// 3xP, mean colour of each seen patch's own texels; (-1,-1,-1) for unseen ones.
Points patchColors(const PaintScene& scene, const std::vector<Image>& atlases);

/// Fills the texels of the unseen patches from colours of the vertices and marks them in the masks.
/// @param colors 3xV, 0..255
void paintUnseen(const PaintScene& scene, const Points& colors, std::vector<Image>& atlases, std::vector<Image>& masks);
} // namespace fresco::texture
