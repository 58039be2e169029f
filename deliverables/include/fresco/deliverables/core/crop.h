// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/textured_mesh.h>
#include <fresco/deliverables/core/crop_region.h>
#include <fresco/deliverables/core/plan.h>
#include <string>
namespace fresco {
/// What lies inside of a region. Faces are cut at its border, where the two sides of an edge get the same new vertices, so that
/// the border of what is left is as clean as the region's; colours, normals, fields and texture coordinates are interpolated
/// and the atlases stay as they are.
/// @param model without texture: `texcoord_faces` is 3x0
/// @return without faces where nothing lies inside
/// @throws std::invalid_argument as validateMesh() and validateCropRegion()
FRESCO_EXPORT TexturedMesh cropModel(TexturedMesh model, const CropRegion& region);

/// The same without texture.
FRESCO_EXPORT TriangleMesh cropMesh(TriangleMesh mesh, const CropRegion& region);

/// Which room of a plan is to be kept.
struct RoomChoice {
  int number = 1;       ///< as planJson() numbers them, from 1
  double margin = 0.05; ///< metres of what lies behind the lines of its walls, >= 0: surfaces lie about them
};

/// From the storey's floor to its ceiling, or up to the sky where none was seen; columns are left out but for the margin.
/// @throws std::invalid_argument if the plan has no such room, or the margin is negative or not finite
FRESCO_EXPORT CropRegion regionOfRoom(const FloorPlan& plan, const RoomChoice& choice);

/// Outlines that a file draws, world x y in metres. GeoJSON: the rings of each Polygon and MultiPolygon. SVG: each polygon,
/// rect and path of straight lines, one unit a metre and y pointing down: world y = -y.
/// @throws std::runtime_error "PATH: reason" if it is missing or malformed, draws nothing, or what it draws has curves or
///         transforms
FRESCO_EXPORT std::vector<Eigen::Matrix2Xd> readOutlines(const std::string& path);
} // namespace fresco
