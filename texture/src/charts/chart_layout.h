// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "charts/chart.h"
namespace fresco::texture {
struct LayoutOptions {
  int border = 2;     ///< texels around each chart
  int largest = 8192; ///< texels, side of a chart with its border
  double most_texels = 1e9;
  int threads = 0;
};

/// Charts of all faces with area, each with its frame and its map of owners; no texel is claimed by two faces.
/// @param density F, texels per mesh unit wanted for each face, > 0
/// @throws std::runtime_error if there would be more than most_texels texels
std::vector<Chart> layOutCharts(const PatchMesh& patches, const FaceGraph& graph, const Eigen::VectorXf& density,
                                const LayoutOptions& options);
} // namespace fresco::texture
