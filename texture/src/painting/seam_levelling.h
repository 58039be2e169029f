// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "views/vertex_views.h"
#include "views/visibility.h"
namespace fresco::texture {
/// Offsets of colour for every view at every vertex where it takes part.
struct SeamOffsets {
  std::vector<int> begin; ///< V + 1: offsets of vertex v, in the order of its shares
  Points offsets;         ///< 3xN, grey levels
};

struct SharedVertices {
  const VertexPatches& around;
  const VertexViews& shares;
};

/// What levelling reads of the photographs.
struct LevellingColors {
  const Candidates& candidates;
  const Points& gains; ///< 3xV, factor per view and channel
};

/// Offsets that let the views agree where they meet and change slowly elsewhere: least squares over the mesh after
/// Lempitsky & Ivanov 2007, "Seamless Mosaicing of Image-Based Texture Maps". What two views differ by is measured on
/// patches that both see, so that detail of the surface does not count.
SeamOffsets levelSeams(const PatchMesh& patches, const SharedVertices& vertices, const LevellingColors& colors,
                       int threads);
} // namespace fresco::texture
