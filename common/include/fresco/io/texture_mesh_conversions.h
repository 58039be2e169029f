// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/textured_mesh.h>
#include <pcl/TextureMesh.h>
#include <string>
#include <vector>
namespace fresco {
/// One sub-mesh and material per atlas, then one for the faces without texture (if any). Texture coordinates stand
/// corner by corner, as pcl::visualization expects them, and tex_coord_indices name them, as pcl::io::saveOBJFile
/// expects. Vertices get normals if the mesh has none, which that function needs.
/// @param image_files tex_file of each material, one per atlas; empty: "texture_0.png", "texture_1.png" ...
FRESCO_EXPORT void toTextureMesh(const TexturedMesh& model, pcl::TextureMesh& texture,
                                 const std::vector<std::string>& image_files = {});

/// Sub-mesh i gets face_atlas i where its polygons have texture coordinates, else -1. Works with and without
/// tex_coord_indices.
/// @param atlases images of the materials, one per sub-mesh; empty: they are read from tex_file, found in `folder`
/// @throws std::invalid_argument if sizes do not agree, std::runtime_error if an image cannot be read
FRESCO_EXPORT TexturedMesh toTexturedMesh(const pcl::TextureMesh& texture, const std::string& folder,
                                          std::vector<Image> atlases = {});
} // namespace fresco
