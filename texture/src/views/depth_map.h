// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "cameras/projector.h"
#include "grid.h"
#include <fresco/search/ray_scene.h>
#include <vector>
namespace fresco::texture {
/// Depth of the nearest surface in each cell of a grid laid over an image.
struct DepthMap {
  int width = 0, height = 0;
  float step = 1;           ///< pixels of the image per cell
  std::vector<float> depth; ///< rows from the top; infinite where nothing is hit

  float at(int x, int y) const { return depth[cellAt(x, y, width)]; }
};

/// Pixels of the image per cell of a depth map of at most so many cells.
float depthStep(const CameraModel& camera, Index most_cells);

/// One ray through the centre of each cell; as fine as the image, but at most `most_cells`.
DepthMap depthMap(const RayScene& scene, const Projector& view, Index most_cells);

/// Minimum over the square of `radius` cells around each cell.
DepthMap nearestWithin(DepthMap map, int radius);
/// Maximum likewise; 0 beyond the image's border.
DepthMap farthestWithin(DepthMap map, int radius);
} // namespace fresco::texture
