// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/textured_mesh.h>
#include <string>
#include <string_view>
namespace fresco::io {
/// NAME.obj, NAME.mtl and the images; the .obj appears last.
void writeTexturedObj(const std::string& path, const TexturedMesh& model);

/// @throws std::runtime_error "PATH: reason"
/// @param empty_atlases whether materials without image have an empty atlas
TexturedMesh readTexturedObj(const std::string& path, bool empty_atlases = false);

/// Binary glTF, one primitive per atlas and one for the faces without texture. `origin` becomes the node's translation.
/// @param jpeg_quality of the images inside, 1..100; 0: PNG
void writeGlb(const std::string& path, const TexturedMesh& model, int jpeg_quality);

/// All triangles of all nodes; vertices at the same place become one.
/// @param folder of the file: buffers and images outside of it are read from there and below only
/// @throws std::runtime_error if malformed
TexturedMesh parseGlb(std::string_view content, const std::string& folder);
} // namespace fresco::io
