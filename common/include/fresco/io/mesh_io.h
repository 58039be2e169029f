// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/mesh.h>
#include <fresco/core/textured_mesh.h>
#include <memory>
#include <string>
#include <vector>
namespace fresco {
/// PLY (ASCII, both binary orders, polygons, triangle strips), OBJ, legacy VTK polydata, STL by extension. Polygons
/// are triangulated as fans. Normals, colours and further scalars per vertex are kept. Coordinates too large for float are
/// kept exact through `origin`.
/// @throws std::runtime_error "PATH: reason" if the file is missing, empty, truncated, malformed or has no vertex;
///         faces may be absent
FRESCO_EXPORT TriangleMesh readMesh(const std::string& path);

/// PLY (binary), OBJ, legacy VTK (binary), VTK XML or STL (binary) by extension; whole or not at all.
FRESCO_EXPORT void writeMesh(const std::string& path, const TriangleMesh& mesh);

/// OBJ + MTL + PNG (`NAME.obj`, `NAME.mtl`, `NAME.png` or `NAME_0.png` ...; `.jpg` with `jpeg_quality`) or binary glTF
/// (`.glb`, images inside, unlit, y-up by a node that turns), by extension. The set of files is whole or absent; the .obj
/// appears last.
/// @param jpeg_quality of the images, 1..100; 0: PNG, without loss
/// @throws std::invalid_argument as validateTexturedMesh(), std::runtime_error "PATH: reason" if it cannot be written
FRESCO_EXPORT void writeTexturedMesh(const std::string& path, const TexturedMesh& model, int jpeg_quality = 0);

/// writeTexturedMesh() of a model whose atlases come one by one, so that not all of them are held. Those of an OBJ file are
/// `NAME_0.png` ..., even one alone; those of a .glb are kept as they are stored.
class FRESCO_EXPORT TexturedMeshWriter {
public:
  /// @param several as several atlases are named; otherwise as one alone
  TexturedMeshWriter(const std::string& path, int jpeg_quality = 0, bool several = true);
  ~TexturedMeshWriter();
  void addAtlas(const Image& atlas);
  /// @param model with as many atlases, whose pixels are not looked at
  /// @throws std::invalid_argument, std::runtime_error as writeTexturedMesh()
  void finish(const TexturedMesh& model);

private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Mask beside a model, of one or several: room.obj -> room_mask.png, room_mask_0.png ...
FRESCO_EXPORT std::string maskPath(const std::string& model, std::size_t index, std::size_t count);

/// A textured mesh in several formats, with the masks of its atlases beside the first file. Atlases may come one by one.
class FRESCO_EXPORT TexturedModelWriter {
public:
  struct File {
    std::string path;
    int jpeg_quality = 0;
  };
  explicit TexturedModelWriter(std::vector<File> files);
  ~TexturedModelWriter();
  void addAtlas(const Image& atlas, const Image& mask);
  /// @param model,masks whole; of what was added, their number and sizes count
  /// @throws std::invalid_argument, std::runtime_error as writeTexturedMesh()
  void finish(const TexturedMesh& model, const std::vector<Image>& masks);

private:
  std::vector<File> files_;
  std::vector<std::unique_ptr<TexturedMeshWriter>> writers_; ///< none: no atlas was added
  std::size_t masks_ = 0;                                    ///< that are written
};

/// What writeTexturedMesh() writes, and OBJ + MTL and .glb of others. Faces whose material has no image, or whose
/// corners have no texture coordinates, are without texture. From a .glb, vertices at the same place become one,
/// and y-up becomes z-up.
/// @throws std::runtime_error "PATH: reason" if the model or a file that it names is missing, truncated or malformed
FRESCO_EXPORT TexturedMesh readTexturedMesh(const std::string& path);

/// The same for its texture coordinates: faces of an OBJ file keep them where there is no image. Each material without one
/// has an empty atlas.
FRESCO_EXPORT TexturedMesh readTextureLayout(const std::string& path);

/// Material libraries and images that an OBJ file names, below its folder; none of other files.
/// @throws std::runtime_error "PATH: reason" if the file cannot be read
FRESCO_EXPORT std::vector<std::string> filesNamedBy(const std::string& path);
} // namespace fresco
