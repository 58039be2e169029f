// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "photographs/grid.h"
#include "photographs/projector.h"
#include <fresco/core/array.h>
#include <fresco/search/ray_scene.h>
#include <vector>
namespace fresco::texture {
/// Depth of the nearest surface in each cell of a grid laid over an image.
struct DepthMap {
  int width = 0, height = 0;
  float step = 1;     ///< pixels of the image per cell
  Array<float> depth; ///< rows from the top; infinite where nothing is hit

  float at(int x, int y) const { return depth[cellAt(x, y, width)]; }
};

/// Pixels of the image per cell of a depth map of at most so many cells.
float depthStep(const CameraModel& camera, Index most_cells);

/// One ray through the centre of each cell; as fine as the image, but at most `most_cells`.
DepthMap depthMap(const RayScene& scene, const Projector& view, Index most_cells);

/// A map in which nothing is hit.
DepthMap emptyMap(const CameraModel& camera, Index most_cells);

/// Part of a surface and the box around it.
struct ScenePart {
  const RayScene& scene;
  Eigen::AlignedBox3f box;
};

/// Brings the map's depths forward to the part where it is nearer. A map that got all parts of a surface is that of the whole.
void addPart(const ScenePart& part, const Projector& view, DepthMap& map);

/// Cells of a map, both ends included.
struct CellBox {
  int x0, x1, y0, y1;
};

/// Minimum over the square of `radius` cells around each cell of the box. The others are of no use.
DepthMap nearestWithin(const DepthMap& map, int radius, const CellBox& cells);
/// Maximum likewise; 0 beyond the image's border.
DepthMap farthestWithin(const DepthMap& map, int radius, const CellBox& cells);
} // namespace fresco::texture
