// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/textured_mesh.h>
#include <string>
namespace fresco {
/// A mesh with or without texture: what readTexturedMesh() reads, else what readMesh() reads. Without texture,
/// `texcoord_faces` is 3x0.
/// @throws std::runtime_error "PATH: reason" if it cannot be read or has no faces
FRESCO_EXPORT TexturedMesh readModel(const std::string& path);

/// Whether some face has a texture.
FRESCO_EXPORT bool isTextured(const TexturedMesh& model);

/// With its texture where there is one and the format holds it (.glb, .obj); else the mesh alone.
/// @param jpeg_quality of the images, 1..100; 0: PNG
/// @throws std::invalid_argument, std::runtime_error as writeTexturedMesh() and writeMesh()
FRESCO_EXPORT void writeModel(const std::string& path, TexturedMesh model, int jpeg_quality = 0);
} // namespace fresco
