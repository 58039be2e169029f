// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/textured_mesh.h>
#include <string>
#include <string_view>
namespace fresco::io {
/// NAME.obj, NAME.mtl and the images; the .obj appears last.
/// @param jpeg_quality of the images, 1..100; 0: PNG
void writeTexturedObj(const std::string& path, const TexturedMesh& model, int jpeg_quality);

/// @throws std::runtime_error "PATH: reason"
/// @param empty_atlases whether materials without image have an empty atlas
TexturedMesh readTexturedObj(const std::string& path, bool empty_atlases = false);

/// Binary glTF, primitives of at most 65535 vertices, each of one atlas or of faces without texture. With JPEG, texture
/// coordinates have 16 bits. glTF is y-up and models
/// are z-up: the node turns, and its translation is `origin`.
/// @param jpeg_quality of the images inside, 1..100; 0: PNG
void writeGlb(const std::string& path, const TexturedMesh& model, int jpeg_quality);

/// All triangles of all nodes, turned from y-up to z-up; vertices at the same place become one.
/// @param folder of the file: buffers and images outside of it are read from there and below only
/// @throws std::runtime_error if malformed
TexturedMesh parseGlb(std::string_view content, const std::string& folder);
} // namespace fresco::io
