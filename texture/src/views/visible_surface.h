// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "views/visibility.h"
namespace fresco::texture {
constexpr double most_patches = 1e6; ///< of a mesh or a tile: bounds the memory

/// What the views show of the mesh.
struct VisibleSurface {
  PatchMesh patches;
  Candidates candidates;             ///< views of each patch
  std::vector<OutlineMask> outlines; ///< of each view; empty where poses are too uncertain for single pixels
};

/// Patches of about 16 pixels of a typical view, smaller ones beside outlines, and the views that show them.
VisibleSurface findVisibleSurface(const TriangleMesh& mesh, const VisibilityInput& input, const Progress& progress);

/// What findVisibleSurface() asks of a surface as a whole, but for its maps.
/// @param tiles that the mesh is cut into
WholeSurface measureSurface(const TriangleMesh& mesh, const ViewList& views, Index tiles);

/// shownDepth() of each view in use, in as many cells as fit into 256 MB together.
std::vector<DepthMap> coarseMaps(const VisibilityInput& input);

/// Cuts the patches that no view shows whole, though some view shows a part of them, to an eighth of their side: what
/// is seen beside something that stands before it can then be painted, and only the rest is unseen.
/// @param maps coarseMaps()
PatchMesh cutHiddenParts(PatchMesh patches, const VisibilityInput& input, const std::vector<DepthMap>& maps);

/// Fills coverage, views_used, seam_length and face_view of the result.
/// @param view -1 = unseen; panoramas as a whole. Of the first patches only, P at most: the others are not counted
void describeViews(const PatchMesh& patches, const Eigen::VectorXi& view, TextureResult& result);

/// Of all faces.
Eigen::AlignedBox3f boxOf(const TriangleMesh& mesh);

/// Diagonal of the bounding box of all faces, mesh units.
double diagonalOf(const TriangleMesh& mesh);
} // namespace fresco::texture
