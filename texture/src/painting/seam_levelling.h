// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "painting/view_blend.h"
#include "views/vertex_views.h"
namespace fresco::texture {
/// Offsets of colour for every view at every vertex where it takes part.
struct SeamOffsets {
  std::vector<int> begin; ///< V + 1: offsets of vertex v, in the order of its shares
  Points offsets;         ///< 3xN, grey levels
};

/// Offsets that let the views agree where they meet and change slowly elsewhere: least squares over the mesh after
/// Lempitsky & Ivanov 2007, "Seamless Mosaicing of Image-Based Texture Maps". What two views differ by is measured on
/// patches that both see, so that detail of the surface does not count.
/// @param around patches at every vertex @param shares views at every vertex
/// Where the options have a border, its offsets stay, and those found become known to it.
SeamOffsets levelSeams(const BlendInput& input, const Groups& around, const VertexViews& shares,
                       const BlendOptions& options);
} // namespace fresco::texture
