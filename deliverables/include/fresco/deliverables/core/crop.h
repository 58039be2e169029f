// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/textured_mesh.h>
#include <fresco/deliverables/core/crop_region.h>
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

/// Outlines that a file draws, world x y in metres. GeoJSON: the rings of each Polygon and MultiPolygon. SVG: each polygon,
/// rect and path of straight lines, one unit a metre and y pointing down: world y = -y.
/// @throws std::runtime_error "PATH: reason" if it is missing or malformed, draws nothing, or what it draws has curves or
///         transforms
FRESCO_EXPORT std::vector<Eigen::Matrix2Xd> readOutlines(const std::string& path);
} // namespace fresco
