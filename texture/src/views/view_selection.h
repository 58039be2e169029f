// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "views/patch_mesh.h"
#include "views/visibility.h"
namespace fresco::texture {
struct ViewCosts {
  const Candidates& candidates;
  const std::vector<float>& extra; ///< octaves added for each candidate, in the order of candidates.list
};

/// View of each patch, -1 where none shows it, that makes small
///   sum over patches of area * octaves of resolution lost + seam * sum over edges between different views of their
///   length, a tenth of it along sharp creases
/// by min-sum belief propagation and iterated conditional modes.
/// @param seam length, mesh units
Eigen::VectorXi selectViews(const PatchMesh& patches, const ViewCosts& costs, double seam, int threads);

/// Length along which two views meet.
double seamLength(const PatchMesh& patches, const Eigen::VectorXi& view);

float edgeLength(const PatchMesh& patches, Index patch, int side);
} // namespace fresco::texture
