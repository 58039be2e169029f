// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/texture/texture_io.h"
#include <unordered_map>
#include <vector>
namespace fresco::io {
using Color16 = Eigen::Matrix<std::uint16_t, 4, 1>;

/// Vertices and triangles of one primitive.
struct GltfPart {
  std::vector<Eigen::Vector3f> positions, normals;
  std::vector<Eigen::Vector4f> tangents;  ///< see texcoordTangents()
  std::vector<Eigen::Vector2f> texcoords; ///< v points down
  std::vector<Color16> colors;            ///< linear RGBA
  std::vector<std::uint32_t> indices;
};

/// Cuts the faces with one atlas into parts, face after face: each pair of vertex and texture coordinate gets one place in
/// a part.
class GltfPartBuilder {
public:
  /// @param atlas -1: the faces without texture
  /// @param faces see facesByAtlas()
  GltfPartBuilder(const TexturedMesh& model, const Groups& faces, int atlas);

  /// @param T of each texture coordinate; they go with the parts
  void addTangents(const Eigen::Matrix4Xf& T) { tangents_ = &T; }

  /// The next part; without indices at the end.
  /// @param most vertices of it, >= 3
  GltfPart next(std::size_t most);

private:
  struct Place {
    int vertex, texcoord, next; ///< next place of the same vertex, -1: none
  };

  std::uint32_t place(int vertex, int texcoord);
  void append(int vertex, int texcoord);

  const TexturedMesh& model_;
  const Groups& faces_;
  const Eigen::Matrix4Xf* tangents_ = nullptr;
  bool textured_;
  Index at_, end_;                     ///< faces that are in no part yet
  std::unordered_map<int, int> first_; ///< place of each vertex of the part
  std::vector<Place> places_;
  std::uint16_t linear_[256]; ///< light of each sRGB byte
  GltfPart part_;
};
} // namespace fresco::io
