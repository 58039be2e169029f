// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "views/patch_mesh.h"
namespace fresco::texture {
/// The corners of patches, joined where the surface goes on smoothly around their vertex: a vertex on a crease has one
/// node for each side, any other has one.
struct SmoothCorners {
  Eigen::Matrix3Xi node;   ///< 3xP, of each corner
  std::vector<int> vertex; ///< N, ascending
  Points normals;          ///< 3xN unit, area-weighted mean of the patches; (0,0,0) without area
  Index size() const { return vertex.size(); }
};

SmoothCorners joinSmoothCorners(const PatchMesh& patches);

/// P, number of the piece that each patch is part of: patches joined over edges that are no creases.
std::vector<int> smoothPieces(const PatchMesh& patches);
} // namespace fresco::texture
