// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "charts/chart.h"
namespace fresco::texture {
/// Patches of each face: those of face f are first[f] .. first[f + 1] - 1.
std::vector<Index> patchesOfFaces(const PatchMesh& patches, Index faces);

/// Fills chart.texels from its frame. A face that would cover a texel of an earlier face of the chart is taken out of
/// it. Texels up to `border` away from the chart belong to the patch nearest by.
/// @return the faces taken out
std::vector<int> rasterizeChart(const PatchMesh& patches, const std::vector<Index>& first_patch, int border,
                                Chart& chart);

/// Corners of a patch in the chart's texels.
Eigen::Matrix<double, 2, 3> patchTexels(const PatchMesh& patches, const Chart& chart, Index patch);
} // namespace fresco::texture
