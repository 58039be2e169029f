// SPDX-License-Identifier: BSD-3-Clause
#include "views/patch_mesh.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <fresco/core/grouped.h>
#include <fresco/core/parallel.h>
#include <numeric>
#include <unordered_map>
namespace fresco::texture {
namespace {
using EdgeKey = std::uint64_t;

EdgeKey edgeKey(int a, int b)
{
  const EdgeKey low = std::min(a, b), high = std::max(a, b);
  return low << 32 | high;
}

struct Patches {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3f> colors; ///< none, or one per vertex
  std::vector<Eigen::Vector3i> faces;
  std::vector<int> parent;
};

/// Middles of edges.
struct Cuts {
  std::unordered_map<EdgeKey, int> middle;
  std::vector<char> touched; ///< vertices at which such edges end

  /// -1 = none
  int at(int a, int b) const
  {
    if (!touched[a] || !touched[b])
      return -1;
    const auto found = middle.find(edgeKey(a, b));
    return found == middle.end() ? -1 : found->second;
  }
};

/// The edges for which want(patch, corner at which the edge begins) holds.
template <typename Want>
Cuts cutEdges(Patches& patches, const Want& want)
{
  Cuts cuts{{}, std::vector<char>(patches.vertices.size(), 0)};
  for (std::size_t i = 0; i < patches.faces.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const int a = patches.faces[i][k], b = patches.faces[i][(k + 1) % 3];
      if (!want(i, k))
        continue;
      if (!cuts.middle.emplace(edgeKey(a, b), patches.vertices.size()).second)
        continue;
      cuts.touched[a] = cuts.touched[b] = 1;
      patches.vertices.push_back(0.5f * (patches.vertices[a] + patches.vertices[b]));
      if (!patches.colors.empty())
        patches.colors.push_back(0.5f * (patches.colors[a] + patches.colors[b]));
    }
  return cuts;
}

/// Parts of a face with corners f whose edges k -> k+1 are cut at m[k] (-1 = not cut).
void appendParts(const Eigen::Vector3i& f, const Eigen::Vector3i& m, std::vector<Eigen::Vector3i>& out)
{
  const int cuts = (m.array() >= 0).count();
  if (cuts == 0)
    out.push_back(f);
  else if (cuts == 3) {
    for (int k = 0; k < 3; ++k)
      out.emplace_back(f[k], m[k], m[(k + 2) % 3]);
    out.push_back(m);
  } else if (cuts == 1) {
    const int k = m[0] >= 0 ? 0 : m[1] >= 0 ? 1 : 2;
    out.emplace_back(f[k], m[k], f[(k + 2) % 3]);
    out.emplace_back(m[k], f[(k + 1) % 3], f[(k + 2) % 3]);
  } else {
    const int k = m[0] < 0 ? 0 : m[1] < 0 ? 1 : 2; // the edge that stays
    const int a = f[k], b = f[(k + 1) % 3], c = f[(k + 2) % 3], bc = m[(k + 1) % 3], ca = m[(k + 2) % 3];
    out.emplace_back(a, b, bc);
    out.emplace_back(a, bc, ca);
    out.emplace_back(ca, bc, c);
  }
}

/// Cuts every patch at the middles that its edges have.
void cutAt(const Cuts& cuts, Patches& patches)
{
  std::vector<Eigen::Vector3i> faces;
  std::vector<int> parent;
  faces.reserve(patches.faces.size());
  parent.reserve(patches.faces.size());
  for (std::size_t i = 0; i < patches.faces.size(); ++i) {
    const Eigen::Vector3i f = patches.faces[i];
    Eigen::Vector3i m;
    for (int k = 0; k < 3; ++k)
      m[k] = cuts.at(f[k], f[(k + 1) % 3]);
    appendParts(f, m, faces);
    parent.resize(faces.size(), patches.parent[i]);
  }
  patches.faces = std::move(faces);
  patches.parent = std::move(parent);
}

/// @return whether anything was cut
bool cutLongEdges(Patches& patches, float longest_edge)
{
  const Cuts cuts = cutEdges(patches, [&](std::size_t i, int k) {
    const Eigen::Vector3i& f = patches.faces[i];
    return (patches.vertices[f[k]] - patches.vertices[f[(k + 1) % 3]]).norm() > longest_edge;
  });
  if (!cuts.middle.empty())
    cutAt(cuts, patches);
  return !cuts.middle.empty();
}

/// @param mesh a TriangleMesh or PatchMesh
template <typename Mesh>
Patches copyOf(const Mesh& mesh)
{
  Patches patches;
  patches.vertices.reserve(mesh.vertices.cols());
  patches.faces.reserve(mesh.faces.cols());
  for (Index v = 0; v < mesh.vertices.cols(); ++v)
    patches.vertices.emplace_back(mesh.vertices.col(v));
  for (Index v = 0; v < mesh.colors.cols(); ++v)
    patches.colors.emplace_back(mesh.colors.col(v).template cast<float>());
  for (Index f = 0; f < mesh.faces.cols(); ++f)
    patches.faces.emplace_back(mesh.faces.col(f));
  return patches;
}

PatchMesh finish(const Patches& patches, int threads)
{
  PatchMesh out;
  const Index n = patches.faces.size();
  const Index corners = patches.vertices.size();
  out.vertices = Eigen::Map<const Points>(patches.vertices.front().data(), 3, corners);
  if (!patches.colors.empty())
    out.colors = Eigen::Map<const Points>(patches.colors.front().data(), 3, corners);
  out.faces = Eigen::Map<const Faces>(patches.faces.front().data(), 3, n);
  out.parent = Eigen::Map<const Eigen::VectorXi>(patches.parent.data(), n);
  out.neighbors = faceNeighbors(out.faces, threads);
  out.normals.resize(3, n);
  out.areas.resize(n);
  parallelFor(n, threads, [&](Index i) {
    const auto corner = [&](int k) { return out.vertices.col(out.faces(k, i)).cast<double>(); };
    const Eigen::Vector3d cross = areaVector(corner(0), corner(1), corner(2));
    const double length = cross.norm();
    out.areas[i] = 0.5 * length;
    out.normals.col(i) = (length > 0 ? Eigen::Vector3d(cross / length) : Eigen::Vector3d::Zero()).cast<float>();
  });
  return out;
}
} // namespace

PatchMesh cutFaces(const TriangleMesh& mesh, float longest_edge, int threads)
{
  constexpr int most_rounds = 16; // each halves the longest edge: a face of 65,000 pixels at most
  Patches patches = copyOf(mesh);
  patches.parent.resize(mesh.faceCount());
  std::iota(patches.parent.begin(), patches.parent.end(), 0);
  for (int round = 0; round < most_rounds && cutLongEdges(patches, longest_edge); ++round)
    ;
  return finish(patches, threads);
}

PatchMesh cutPatches(const PatchMesh& patches, const std::vector<char>& marked, int threads)
{
  Patches parts = copyOf(patches);
  parts.parent.assign(patches.parent.begin(), patches.parent.end());
  const Cuts cuts = cutEdges(parts, [&](std::size_t i, int) { return marked[i] != 0; });
  if (cuts.middle.empty())
    return patches;
  cutAt(cuts, parts);
  return finish(parts, threads);
}

Eigen::Matrix3Xi faceNeighbors(const Faces& faces, int threads)
{
  Eigen::Matrix3Xi neighbors = Eigen::Matrix3Xi::Constant(3, faces.cols(), -1);
  if (faces.cols() == 0)
    return neighbors;
  const auto endsOf = [&](int slot) { // slot: 3 * face + corner at which the side begins
    return std::minmax({faces.data()[slot], faces.data()[slot % 3 == 2 ? slot - 2 : slot + 1]});
  };
  const Groups sides = grouped(faces.size(), faces.maxCoeff() + 1, [&](Index slot) { return endsOf(slot).first; });
  parallelRanges(sides.begin.size() - 1, threads, [&](Index begin, Index end) {
    std::vector<std::pair<int, int>> around; // other end, slot
    for (Index v = begin; v < end; ++v) {
      around.clear();
      for (Index s = sides.begin[v]; s < sides.begin[v + 1]; ++s)
        if (const int other = endsOf(sides.list[s]).second; other != v)
          around.emplace_back(other, sides.list[s]);
      std::sort(around.begin(), around.end());
      for (std::size_t i = 0, next = 0; i < around.size(); i = next) {
        for (next = i + 1; next < around.size() && around[next].first == around[i].first; ++next)
          ;
        if (next - i != 2)
          continue;
        neighbors.data()[around[i].second] = around[i + 1].second / 3;
        neighbors.data()[around[i + 1].second] = around[i].second / 3;
      }
    }
  });
  return neighbors;
}
} // namespace fresco::texture
