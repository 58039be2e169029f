// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "views/patch_mesh.h"
#include <fresco/core/grouped.h>
#include <vector>
namespace fresco::texture {
constexpr float least_share = 0.02f; ///< of a view in a colour: 5 grey levels of 255 at most

/// Patches at every vertex.
Groups vertexPatches(const PatchMesh& patches);

/// A view's part in the colour at a vertex.
struct VertexShare {
  int view;
  float weight;
};

/// By vertex, each list by view number; weights sum to 1. Empty where no patch is seen.
using VertexViews = std::vector<std::vector<VertexShare>>;

/// Shares of the views of the patches around each vertex, widened by `rounds` of averaging over neighbours.
VertexViews shareVertices(const PatchMesh& patches, const Groups& around, const Eigen::VectorXi& view, int rounds);
} // namespace fresco::texture
