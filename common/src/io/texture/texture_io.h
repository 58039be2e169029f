// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/grouped.h>
#include <fresco/core/textured_mesh.h>
#include <fresco/io/file.h>
#include <fresco/io/gltf.h>
#include <memory>
#include <string>
#include <string_view>
namespace fresco::io {
/// Faces of atlas i as group i + 1; those without texture as group 0.
Groups facesByAtlas(const TexturedMesh& model);

/// NAME.obj, NAME.mtl and the images, or NAME.ply and the images, of which all or none get their names.
class ImageFilesWriter {
public:
  ImageFilesWriter(const std::string& path, int jpeg_quality);
  /// @param suffix of the image's name
  void addAtlas(const Image& atlas, const std::string& suffix);
  /// @param model whose atlases' pixels are not looked at
  void finish(const TexturedMesh& model);

private:
  std::string folder_, stem_, kind_;
  int quality_;
  OutputFile object_;
  std::unique_ptr<OutputFile> materials_; ///< of .obj
  std::vector<std::string> names_;
  std::vector<std::unique_ptr<OutputFile>> images_;
};

/// The model as MeshLab, OpenMVS and Metashape have it: comments TextureFile, texcoord and texnumber of each face.
void writeTexturedPly(OutputFile& file, const TexturedMesh& model, const std::vector<std::string>& images);

/// The same of others, also with s t, u v or texture_u texture_v of each vertex.
/// @throws std::runtime_error "PATH: reason", also if it names no image
TexturedMesh readTexturedPly(const std::string& path);

/// As a path here, whatever system wrote it.
std::string portablePath(std::string name);

/// @throws std::runtime_error "PATH: reason"
/// @param empty_atlases whether materials without image have an empty atlas
TexturedMesh readTexturedObj(const std::string& path, bool empty_atlases = false);

/// What is stored.
struct GltfScene {
  const TexturedMesh& model;
  const std::vector<Image>& normal_maps; ///< see GltfModel
};

/// Binary glTF. glTF is y-up and models are z-up: the node turns.
/// @param images of the atlases as they are stored
void writeGlb(const std::string& path, const GltfScene& scene, const GltfOptions& options,
              std::vector<std::vector<std::uint8_t>> images);

/// An image as it is stored: PNG, or JPEG of a quality above 0.
std::vector<std::uint8_t> storedImage(const Image& image, int jpeg_quality);

/// All triangles of all nodes, turned from y-up to z-up; vertices at the same place become one.
/// @param folder of the file: buffers and images outside of it are read from there and below only
/// @throws std::runtime_error if malformed
GltfModel parseGlb(std::string_view content, const std::string& folder);
} // namespace fresco::io
