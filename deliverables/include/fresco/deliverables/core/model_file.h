// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/textured_mesh.h>
#include <fresco/io/gltf.h>
#include <optional>
#include <string>
namespace fresco {
/// A mesh with or without texture: what readGltf() and readTexturedMesh() read, else what readMesh() reads. Without texture,
/// `texcoord_faces` is 3x0.
/// @throws std::runtime_error "PATH: reason" if it cannot be read or has no faces
FRESCO_EXPORT GltfModel readModel(const std::string& path);

/// The same; nothing of a file that holds no faces: one of points alone, by its extension or its content.
FRESCO_EXPORT std::optional<GltfModel> readModelIfAny(const std::string& path);

/// Whether some face has a texture; whether there is one, or colours of vertices.
FRESCO_EXPORT bool isTextured(const TexturedMesh& model);
FRESCO_EXPORT bool isColored(const TexturedMesh& model);

/// With its texture where there is one and the format holds it (.glb, .obj), normal maps in .glb only; else the mesh alone.
/// @param options of .glb; of .obj, the quality of its pictures
/// @throws std::invalid_argument, std::runtime_error as writeGltf(), writeTexturedMesh() and writeMesh()
FRESCO_EXPORT void writeModel(const std::string& path, GltfModel model, const GltfOptions& options = {});
} // namespace fresco
