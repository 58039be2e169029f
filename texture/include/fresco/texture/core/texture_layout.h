// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/textured_mesh.h>
namespace fresco {
/// Charts of a mesh, packed into atlases that are still to be painted.
struct TextureLayoutOptions {
  double texel = 0; ///< side of a texel in mesh units, > 0
  int atlas = 8192; ///< largest side of an atlas, 128..16384 pixels, more atlases beyond
  int border = 4;   ///< texels around each chart that are its own, 1..16
  int threads = 0;  ///< 0 = all cores; the result does not depend on it
};

/// The texture coordinates that reconstructTexture() would give, with equal texels on all faces. Faces without area have none.
/// @param mesh as validateMesh() wants it, with at least one face of positive area
/// @return with grey atlases, all of one size
/// @throws std::invalid_argument if the mesh or an option is out of range
/// @throws std::runtime_error if there would be more than a thousand megatexels
FRESCO_EXPORT TexturedMesh layOutTexture(TriangleMesh mesh, const TextureLayoutOptions& options);
} // namespace fresco
