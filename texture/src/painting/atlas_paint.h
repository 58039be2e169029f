// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "charts/chart.h"
#include "painting/view_blend.h"
#include "views/outline_mask.h"
namespace fresco::texture {
/// Where the texels of a patch are.
struct TexelSlot {
  int chart = -1;  ///< -1 = it has none
  int number = -1; ///< of the patch in the chart's texels
};

/// What painting reads.
struct PaintScene {
  const PatchMesh& patches;
  const std::vector<Chart>& charts;
  const Eigen::VectorXi& view;         ///< P, -1 = unseen
  const std::vector<TexelSlot>& slots; ///< P
  int threads;

  bool hasTexels(Index patch) const { return slots[patch].chart >= 0; }
  /// @param patch that has texels
  const Chart& chartOf(Index patch) const { return charts[slots[patch].chart]; }
  /// Whether a patch has texels and is painted from photographs.
  bool isSeen(Index patch) const { return view[patch] >= 0 && hasTexels(patch); }
};

/// A texel of a patch, in its chart.
struct PatchTexel {
  int patch, x, y;
};

/// P, see PaintScene::slots.
std::vector<TexelSlot> texelSlots(const std::vector<Chart>& charts, Index patches);

/// Whether the seen surface goes on straight beyond a side of the patch, the one from corner `side` to the next.
bool goesOn(const PaintScene& scene, Index patch, int side);

/// Where colours come from.
struct PaintSources {
  const std::vector<Projector>& views;
  PhotoStore& photos;
  const Photometry& photometry;
  const Blend& blend;                    ///< views that each patch is painted from
  const Candidates& candidates;          ///< views that show each patch
  const std::vector<float>& penalties;   ///< octaves, of each candidate: photo-consistency
  const std::vector<OutlineMask>& masks; ///< of the views, or none
};

/// visit(view, its photograph, list) for the lists by view that hold something, so that each photograph is read once.
template <typename List, typename Visit>
void forViews(const std::vector<List>& by_view, PhotoStore& photos, const Visit& visit)
{
  for (std::size_t v = 0; v < by_view.size(); ++v)
    if (!by_view[v].empty())
      visit(int(v), *photos.get(v), by_view[v]);
}

/// Fills the texels of the seen patches from their photographs.
void paintSeen(const PaintScene& scene, const PaintSources& sources, std::vector<Image>& atlases);

/// Fills these texels anew, each from one view alone.
/// @param by_view those of a patch one after the other
void paintTexels(const PaintScene& scene, const PaintSources& sources,
                 const std::vector<std::vector<PatchTexel>>& by_view, std::vector<Image>& atlases);

/// 3xP, mean colour of each seen patch's own texels; (-1,-1,-1) for unseen ones.
Points patchColors(const PaintScene& scene, const std::vector<Image>& atlases);

/// Fills the texels of the unseen patches from colours of their corners and marks them in the masks.
/// @param colors 3x3P, 0..255
void paintUnseen(const PaintScene& scene, const Points& colors, std::vector<Image>& atlases, std::vector<Image>& masks);
} // namespace fresco::texture
