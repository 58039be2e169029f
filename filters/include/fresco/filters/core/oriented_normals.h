// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/point_set.h>
#include <fresco/core/progress.h>
#include <fresco/search/neighbors.h>
namespace fresco {
struct NormalOptions {
  int k = 16; ///< neighbours of the plane fit, the point included, 3..1000; where `radius` is 0: the nearest, or, where
              ///< they lie closer together than the noise allows, at least as many from farther off
  float radius = 0;      ///< length, >= 0; > 0: neighbours within it, but at least the 6 nearest
  bool edges = true;     ///< fit beside an edge to the side that the point lies on
  Index image_width = 0; ///< > 0: the points are an image, row by row, and `k` neighbours come from around the pixel
  int threads = 0;       ///< 0 = all cores; the result does not depend on it
};

/// By point of the input; NaN (confidence 0) for points that are not finite and where no direction can be told: fewer
/// than three points or a line, unless a viewpoint tells it.
struct NormalField {
  Points normals;              ///< 3xN, unit
  Eigen::VectorXf curvatures;  ///< N, share of the smallest of the three variances of the neighbourhood, 0..1/3
  Eigen::VectorXf confidences; ///< N, 0..1: 1 = seen at a right angle on a surface with enough neighbours
};

/// Normals of a surface from its points: least squares planes of neighbourhoods (Hoppe et al. 1992, "Surface
/// reconstruction from unorganized points"); next to an edge, the fit is repeated with the points that lie on the
/// flattest plane nearby that holds the point, and where planes of both sides do, the ray from the viewpoint tells
/// which it meets (noise is taken to lie along the ray). Normals point to where the point was seen from
/// (set.viewpoints); where no viewpoints are known, orientNormals() turns them.
/// @throws std::invalid_argument if an option is out of range, the set is malformed or a viewpoint is not finite
/// @throws Cancelled
FRESCO_EXPORT NormalField estimateNormals(const PointSet& set, const NormalOptions& options = {},
                                          const Progress& progress = {});

/// As above with neighbours that were found elsewhere; options.k, radius and image_width have no effect.
/// @param neighbors of each point, by column: columns, the point included, at most 1000; none = no normal
/// @throws std::invalid_argument also if there are not as many lists as points, or a list is longer
FRESCO_EXPORT NormalField estimateNormalsFromNeighbors(const PointSet& set, const NeighborLists& neighbors,
                                                       const NormalOptions& options = {},
                                                       const Progress& progress = {});
} // namespace fresco
