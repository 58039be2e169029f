// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/textured_mesh.h>
#include <string>
#include <vector>
namespace fresco {
/// What binary glTF holds of a model.
struct GltfModel {
  TexturedMesh model;
  /// RGB, one per atlas of any size, some may be empty; or none. Normals in the frame of tangent, bitangent (green) and normal as
  /// glTF 2.0 has them, 0..255 standing for -1..1; see texcoordTangents().
  std::vector<Image> normal_maps;
};

/// 4xT, what normal maps are relative to: of each texture coordinate the unit direction in which u grows, in the plane across
/// the vertex normal, and the sign of the bitangent, sign * normal x tangent, which points up in the image. Means of the faces
/// around, weighted by area.
/// @param model with normals; each texture coordinate is of one vertex
FRESCO_EXPORT Eigen::Matrix4Xf texcoordTangents(const TexturedMesh& model);

/// How a model is stored as binary glTF 2.0.
struct GltfOptions {
  int jpeg_quality = 0; ///< of the images inside, normal maps included, 1..100; 0: PNG, without loss
  /// One primitive for each atlas, positions, normals and tangents with 16 bits (KHR_mesh_quantization): a position is off by
  /// at most 1/131,070 of the longest side. Otherwise floats, in primitives of at most 65,535 vertices.
  bool compact = false;
  bool compress = false; ///< vertices and indices by EXT_meshopt_compression: a third or less, without further loss
  bool lit = false;      ///< a viewer lights the surface. Otherwise colours are shown as they are (KHR_materials_unlit)
  /// World from model, both z-up: kept in the node, where doubles have room for large coordinates.
  Eigen::Matrix4d T_world_model = Eigen::Matrix4d::Identity();
};

/// Binary glTF; whole or not at all. Normal maps are kept where the mesh has normals.
/// @param path .glb
/// @throws std::invalid_argument as validateTexturedMesh(), if normal maps are neither none nor one per atlas or an option is out
///         of range, std::runtime_error "PATH: reason"
FRESCO_EXPORT void writeGltf(const std::string& path, const GltfModel& model, const GltfOptions& options = {});

/// readTexturedMesh() of a .glb, with its normal maps.
/// @throws std::runtime_error as readTexturedMesh()
FRESCO_EXPORT GltfModel readGltf(const std::string& path);
} // namespace fresco
