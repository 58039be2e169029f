// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/textured_mesh.h>
#include <vector>
namespace fresco::deliverables {
/// How far a vertex may move.
enum class Freedom : std::uint8_t {
  surface, ///< anywhere
  curve,   ///< along the border or seam that it lies on
  none
};

/// Faces around each vertex of a model whose edges are collapsed, as lists of corners: corner 3 f + k is corner k of face f.
class CornerTable {
public:
  /// @param model whose faces and texture coordinates collapse() changes; each texture coordinate is of one vertex
  explicit CornerTable(TexturedMesh& model);

  /// visit(face, k): the corner of each face around a vertex
  template <typename Visit>
  void forFaces(int vertex, const Visit& visit) const
  {
    for (int corner = first_[vertex]; corner >= 0; corner = next_[corner])
      if (isAlive(corner / 3))
        visit(corner / 3, corner % 3);
  }

  bool isAlive(int face) const { return model_.mesh.faces(0, face) >= 0; }
  Index faces() const { return faces_; } ///< that are left
  Freedom freedom(int vertex) const { return freedom_[vertex]; }
  void fix(int vertex) { freedom_[vertex] = Freedom::none; }
  /// Ascending, each once.
  std::vector<int> neighbors(int vertex) const;

  /// What lies at an edge.
  struct EdgeFaces {
    int count = 0;          ///< faces
    int face[2] = {-1, -1}; ///< the first two
    int tip[2] = {-1, -1};  ///< their third vertices
    int from[2] = {-1, -1}; ///< corners at the edge's vertices
    int to[2] = {-1, -1};
  };
  EdgeFaces edge(int from, int to) const;
  /// Whether a border or a seam runs along it.
  bool isCurve(const EdgeFaces& edge) const;

  /// Whether the surface has the same topology, its curves included, when both ends are one.
  bool mayCollapse(int from, int to, const EdgeFaces& edge) const;

  /// Lets `from` become `to`.
  /// @param share of the way at which the new vertex lies: texture coordinates are interpolated
  void collapse(int from, int to, double share);

private:
  void classify(int vertex);
  int texcoord(int corner) const { return textured_ ? model_.texcoord_faces(corner % 3, corner / 3) : -1; }

  TexturedMesh& model_;
  bool textured_;
  Index faces_ = 0;
  std::vector<int> first_, next_; ///< first corner of each vertex, next one of each corner
  std::vector<Freedom> freedom_;
};
} // namespace fresco::deliverables
