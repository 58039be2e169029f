// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <fresco/core/mesh.h>
#include <vector>
namespace fresco::optimization {
/// Vertex positions of the optimiser: origin in the middle of the mesh, mean edge length 1.
using Positions = Eigen::Matrix3Xd;

/// 0 up to `zero`, 1 from `one` on (which may be the smaller), linear between. A decision that falls at one value lets
/// rounding choose between two surfaces; all decisions of the optimiser fall over a ramp.
inline double ramp(double value, double zero, double one)
{
  return std::clamp((value - zero) / (one - zero), 0.0, 1.0);
}

/// Who touches whom in a mesh. Faces with a repeated index have no edges and touch nobody.
struct MeshGraph {
  Faces faces;                                ///< 3xF
  std::vector<std::array<int, 2>> edges;      ///< the two vertices, ascending; sorted
  std::vector<std::array<int, 2>> edge_faces; ///< -1: boundary (second), or three faces and more (both)
  Faces face_edges;                           ///< 3xF, edge k joins corners k and k + 1; -1 for a degenerate face
  std::vector<int> face_begin, vertex_faces;  ///< faces around vertex v: vertex_faces[face_begin[v] ..]
  std::vector<int> edge_begin, vertex_edges;  ///< edges around vertex v: vertex_edges[edge_begin[v] ..]
  std::vector<char> border;                   ///< V, 1 at boundary edges and edges of three faces and more

  Index vertexCount() const { return border.size(); }
  Index faceCount() const { return faces.cols(); }
  Index edgeCount() const { return edges.size(); }
  int otherVertex(Index edge, Index vertex) const
  {
    const auto& ends = edges[edge];
    return ends[0] == vertex ? ends[1] : ends[0];
  }
  /// The face across corner k's edge (k, k + 1) of `face`, or -1.
  int across(Index face, int k) const
  {
    const int edge = face_edges(k, face);
    if (edge < 0)
      return -1;
    const auto& sides = edge_faces[edge];
    return sides[0] == face ? sides[1] : sides[1] == face ? sides[0] : -1;
  }
};

/// A contiguous run of a CSR array, for range loops.
struct IntRange {
  const int *first, *last;
  const int* begin() const { return first; }
  const int* end() const { return last; }
  Index size() const { return last - first; }
};

inline IntRange facesAround(const MeshGraph& graph, Index v)
{
  return {graph.vertex_faces.data() + graph.face_begin[v], graph.vertex_faces.data() + graph.face_begin[v + 1]};
}

inline IntRange edgesAround(const MeshGraph& graph, Index v)
{
  return {graph.vertex_edges.data() + graph.edge_begin[v], graph.vertex_edges.data() + graph.edge_begin[v + 1]};
}

MeshGraph buildGraph(const Faces& faces, Index vertices, int threads);

/// Mean position of the vertices that share an edge with v; there is at least one.
inline Eigen::Vector3d meanOfNeighbours(const MeshGraph& graph, const Positions& x, Index v)
{
  const IntRange edges = edgesAround(graph, v);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int e : edges)
    sum += x.col(graph.otherVertex(e, v));
  const double count = edges.size();
  return sum / count;
}

/// Cross product of two sides of face f, twice the area long.
inline Eigen::Vector3d areaVector(const MeshGraph& graph, const Positions& x, Index f)
{
  const Eigen::Vector3d a = x.col(graph.faces(0, f));
  return (x.col(graph.faces(1, f)) - a).cross(x.col(graph.faces(2, f)) - a);
}

/// Twice an area, squared mean edge lengths; that of an equilateral triangle is 0.87. Directions of smaller faces turn too
/// much with what moves their corners a little to decide anything.
constexpr double small_area = 0.1;

/// 3xF: areaVector() of every face, zero for degenerate ones.
Eigen::Matrix3Xd areaVectors(const MeshGraph& graph, const Positions& x, int threads);

/// Leaves of values along the boundary the waves that are longer than about twenty vertices, unchanged, where `part` is 1,
/// and all of them where it is 0. Taubin 1995, "A signal processing approach to fair surface design".
void smoothAlongBoundary(const MeshGraph& graph, const Eigen::VectorXf& part, Positions& values, int threads);

/// Mean over edges.
double meanEdgeLength(const MeshGraph& graph, const Positions& x, int threads);
} // namespace fresco::optimization
