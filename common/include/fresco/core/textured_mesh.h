// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/image.h>
#include <fresco/core/mesh.h>
#include <vector>
namespace fresco {
/// Mesh with texture atlases. Texture coordinates as in OpenGL and OBJ: (0,0) is the lower left corner of the image,
/// v points up, the centre of texel i lies at (i + 0.5) / size.
struct TexturedMesh {
  TriangleMesh mesh;
  Eigen::Matrix2Xf texcoords;      ///< 2xT, 0..1
  Eigen::Matrix3Xi texcoord_faces; ///< 3xF, columns into texcoords; -1 in all three where a face has no texture
  Eigen::VectorXi face_atlas;      ///< F, index into atlases; -1 where a face has no texture
  std::vector<Image> atlases;      ///< RGB
};

/// Checks that every face has an atlas and three texture coordinates that exist, or neither.
/// @throws std::invalid_argument if this does not hold, the mesh is not valid, texture coordinates are not finite or
///         an atlas that a face uses is no RGB image
FRESCO_EXPORT void validateTexturedMesh(const TexturedMesh& model);
} // namespace fresco
