// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdint>
#include <fresco/core/mesh.h>
#include <fresco/core/require.h>
#include <fresco/core/union_find.h>
namespace fresco {
namespace {
/// One side of a face: the edge from `low` to `high`, or the other way round.
struct HalfEdge {
  std::uint64_t key;    ///< low vertex in the upper half, high vertex in the lower
  std::uint32_t corner; ///< 3 * face + k: the edge from corner k to corner k + 1
  bool forward;         ///< the face runs from low to high
};

std::vector<HalfEdge> sortedHalfEdges(const TriangleMesh& mesh)
{
  std::vector<HalfEdge> edges;
  edges.reserve(mesh.faces.size());
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const Eigen::Vector3i face = mesh.faces.col(f);
    if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0])
      continue;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = face[k], b = face[(k + 1) % 3], corner = 3 * f + k;
      edges.push_back({std::uint64_t{std::min(a, b)} << 32 | std::max(a, b), corner, a < b});
    }
  }
  std::sort(edges.begin(), edges.end(),
            [](const HalfEdge& a, const HalfEdge& b) { return a.key != b.key ? a.key < b.key : a.corner < b.corner; });
  return edges;
}

std::uint32_t nextCorner(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

/// The corner of the edge's face that lies at the edge's lower (or higher) vertex.
std::uint32_t cornerAt(const HalfEdge& edge, bool low)
{
  return edge.forward == low ? edge.corner : nextCorner(edge.corner);
}

/// Counts the edges [begin, end) with one key and joins the fans of the two faces of a manifold edge.
void countEdge(const HalfEdge* begin, const HalfEdge* end, MeshTopology& topology, UnionFind& fans)
{
  ++topology.edges;
  if (end - begin == 1) {
    ++topology.boundary_edges;
  } else if (end - begin == 2) {
    topology.inconsistent_edges += begin[0].forward == begin[1].forward;
  } else {
    ++topology.nonmanifold_edges;
    const auto forward = std::count_if(begin, end, [](const HalfEdge& edge) { return edge.forward; });
    topology.inconsistent_edges += 2 * forward != end - begin;
  }
  for (const HalfEdge* other = begin + 1; other < end; ++other)
    for (const bool low : {true, false})
      fans.join(cornerAt(begin[0], low), cornerAt(*other, low));
}

/// Corners of one vertex that fall into more than one fan make it non-manifold.
void countVertices(const TriangleMesh& mesh, MeshTopology& topology, UnionFind& fans)
{
  constexpr std::uint32_t none = 0xffffffffU;
  std::vector<std::uint32_t> fan(mesh.vertexCount(), none);
  std::vector<bool> split(fan.size(), false);
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const Eigen::Vector3i face = mesh.faces.col(f);
    if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0])
      continue;
    for (int k = 0; k < 3; ++k) {
      const int v = face[k];
      const std::uint32_t root = fans.root(3 * f + k);
      if (fan[v] == none) {
        fan[v] = root;
        ++topology.referenced_vertices;
      } else if (fan[v] != root && !split[v]) {
        split[v] = true;
        ++topology.nonmanifold_vertices;
      }
    }
  }
}

Index countComponents(const TriangleMesh& mesh, const std::vector<HalfEdge>& edges)
{
  UnionFind sets(mesh.vertexCount());
  std::vector<bool> used(mesh.vertexCount(), false);
  for (const HalfEdge& edge : edges) {
    const std::uint32_t a = edge.key >> 32, b = edge.key & 0xffffffff;
    used[a] = used[b] = true;
    sets.join(a, b);
  }
  Index count = 0;
  for (std::uint32_t v = 0; v < used.size(); ++v)
    count += used[v] && sets.root(v) == v;
  return count;
}
} // namespace

MeshTopology meshTopology(const TriangleMesh& mesh)
{
  require(mesh.faces.size() == 0 || (mesh.faces.minCoeff() >= 0 && mesh.faces.maxCoeff() < mesh.vertexCount()),
          "mesh: a face names a vertex that does not exist");
  const std::vector<HalfEdge> edges = sortedHalfEdges(mesh);
  MeshTopology topology;
  UnionFind fans(mesh.faces.size());
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].key == edges[begin].key)
      ++end;
    countEdge(edges.data() + begin, edges.data() + end, topology, fans);
  }
  countVertices(mesh, topology, fans);
  topology.components = countComponents(mesh, edges);
  topology.euler = topology.referenced_vertices - topology.edges + Index(edges.size() / 3);
  topology.watertight = !edges.empty() && topology.boundary_edges == 0 && topology.nonmanifold_edges == 0 &&
                        topology.inconsistent_edges == 0 && topology.nonmanifold_vertices == 0;
  return topology;
}
} // namespace fresco
