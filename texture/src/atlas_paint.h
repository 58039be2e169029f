// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "chart.h"
#include "view_blend.h"
namespace fresco {
/// What painting reads.
struct PaintScene {
  const PatchMesh& patches;
  const std::vector<Chart>& charts;
  const Eigen::VectorXi& face_chart; ///< F, -1 = none
  const Eigen::VectorXi& view;       ///< P, -1 = unseen
  int border;                        ///< texels
  int threads;
};

/// Where colours come from.
struct PaintSources {
  const std::vector<Projector>& views;
  const Points& gains; ///< 3xV, factor per view and channel
  const Blend& blend;
  PhotoStore& photos;
};

/// Fills the texels of the seen patches from their photographs.
void paintSeen(const PaintScene& scene, const PaintSources& sources, std::vector<Image>& atlases);

/// 3xP, mean colour of each seen patch's own texels; (-1,-1,-1) for unseen ones.
Points patchColors(const PaintScene& scene, const std::vector<Image>& atlases);

/// Fills the texels of the unseen patches from colours of the vertices and marks them in the masks.
/// @param colors 3xV, 0..255
void paintUnseen(const PaintScene& scene, const Points& colors, std::vector<Image>& atlases, std::vector<Image>& masks);
} // namespace fresco
