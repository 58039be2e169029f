// SPDX-License-Identifier: BSD-3-Clause
#include "draw_mesh.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fresco/core/constants.h>
#include <fresco/core/parallel.h>
#include <unordered_map>
namespace fresco::rendering {
namespace {
/// Vertex of each corner of `faces`, renumbered without gaps in ascending order; `source` gets the old numbers.
Faces renumber(const Faces& faces, Index vertex_count, std::vector<int>& source)
{
  std::vector<int> number(vertex_count, -1);
  for (Index i = 0; i < faces.size(); ++i)
    number[faces.data()[i]] = 0;
  for (std::size_t v = 0; v < number.size(); ++v)
    if (number[v] == 0) {
      number[v] = source.size();
      source.push_back(v);
    }
  return faces.unaryExpr([&](int v) { return number[v]; });
}

/// Vertices and colours of `source`.
void fillVertices(DrawMesh& drawn, const TriangleMesh& mesh)
{
  drawn.vertices = mesh.vertices(Eigen::all, drawn.source);
  if (mesh.colors.cols() > 0)
    drawn.colors = mesh.colors(Eigen::all, drawn.source);
}

/// Corners (face * 3 + k) around each vertex, ascending: corners[start[v]] .. corners[start[v + 1]].
struct VertexCorners {
  std::vector<Index> start, corners;
  Index count(Index v) const { return start[v + 1] - start[v]; }
  const Index* begin(Index v) const { return corners.data() + start[v]; }
};

VertexCorners cornersOfVertices(const Faces& faces, Index vertex_count)
{
  VertexCorners around;
  around.start.assign(vertex_count + 1, 0);
  for (Index i = 0; i < faces.size(); ++i)
    ++around.start[faces.data()[i] + 1];
  for (std::size_t v = 1; v < around.start.size(); ++v)
    around.start[v] += around.start[v - 1];
  around.corners.resize(faces.size());
  std::vector<Index> next(around.start.begin(), around.start.end() - 1);
  for (Index i = 0; i < faces.size(); ++i)
    around.corners[next[faces.data()[i]]++] = i;
  return around;
}

/// Area times normal in a unit that suits the size of the model,
/// so that neither tiny nor huge models leave float's range.
Points areaVectors(const Points& vertices, const Faces& faces, int threads)
{
  Points areas(3, faces.cols());
  if (faces.cols() == 0)
    return areas;
  const double size =
      (vertices.rowwise().maxCoeff().cast<double>() - vertices.rowwise().minCoeff().cast<double>()).norm();
  const double scale = size > 0 ? 1e3 / size : 1.0;
  parallelFor(faces.cols(), threads, [&](Index f) {
    const Eigen::Vector3d a = vertices.col(faces(0, f)).cast<double>();
    const Eigen::Vector3d b = vertices.col(faces(1, f)).cast<double>(), c = vertices.col(faces(2, f)).cast<double>();
    areas.col(f) = (scale * (b - a)).cross(scale * (c - a)).cast<float>();
  });
  return areas;
}

class CreaseNormals {
public:
  CreaseNormals(const DrawMesh& mesh, double crease_angle, int threads)
      : areas_(areaVectors(mesh.vertices, mesh.faces, threads)), directions_(areas_.colwise().normalized()),
        around_(cornersOfVertices(mesh.faces, mesh.vertices.cols())), cosine_(std::cos(crease_angle * pi / 180))
  {}

  const VertexCorners& around() const { return around_; }

  /// Whether an edge among the faces around `v` may be a crease.
  bool isCreased(Index v) const
  {
    const Index n = around_.count(v);
    if (n > most_corners)
      return true;
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < i; ++j)
        if (!sameSurface(face(v, i), face(v, j)))
          return true;
    return false;
  }

  /// Mean normal at corner number `corner` of `v` over the faces on its side of all creases.
  Eigen::Vector3f normal(Index v, Index corner) const
  {
    const Index own = face(v, corner), n = around_.count(v);
    if (n > most_corners)
      return directions_.col(own);
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (Index i = 0; i < n; ++i)
      if (i == corner || sameSurface(own, face(v, i)))
        sum += areas_.col(face(v, i));
    return sum.norm() > 0 ? Eigen::Vector3f(sum.normalized()) : Eigen::Vector3f(directions_.col(own));
  }

private:
  static constexpr Index most_corners = 256; // beyond, comparing all pairs costs too much: such a vertex is drawn flat

  Index face(Index v, Index corner) const { return around_.begin(v)[corner] / 3; }
  bool sameSurface(Index f, Index g) const
  {
    return areas_.col(f).isZero(0) || areas_.col(g).isZero(0) || directions_.col(f).dot(directions_.col(g)) >= cosine_;
  }

  Points areas_, directions_;
  VertexCorners around_;
  float cosine_;
};
} // namespace

DrawMesh plainMesh(const TriangleMesh& mesh)
{
  DrawMesh drawn;
  drawn.faces = renumber(mesh.faces, mesh.vertexCount(), drawn.source);
  fillVertices(drawn, mesh);
  return drawn;
}

DrawMesh creasedMesh(const TriangleMesh& mesh, double crease_angle, int threads)
{
  const DrawMesh plain = plainMesh(mesh);
  const CreaseNormals crease(plain, crease_angle, threads);
  const Index count = plain.vertices.cols();
  std::vector<char> creased(count);
  parallelFor(count, threads, [&](Index v) { creased[v] = crease.isCreased(v); });
  std::vector<Index> first(creased.size());
  DrawMesh drawn;
  for (std::size_t v = 0; v < creased.size(); ++v) {
    first[v] = drawn.source.size();
    drawn.source.insert(drawn.source.end(), creased[v] ? crease.around().count(v) : 1, plain.source[v]);
  }
  fillVertices(drawn, mesh);
  drawn.faces.resize(3, plain.faces.cols());
  drawn.normals.resize(3, drawn.vertices.cols());
  parallelFor(count, threads, [&](Index v) {
    const bool split = creased[v];
    for (Index i = 0; i < crease.around().count(v); ++i) {
      const Index to = first[v] + (split ? i : 0);
      drawn.faces.data()[crease.around().begin(v)[i]] = to;
      if (split || i == 0)
        drawn.normals.col(to) = crease.normal(v, i);
    }
  });
  return drawn;
}

Colors normalColors(const Points& normals) { return ((normals.array() + 1.f) * 127.5f + 0.5f).cast<std::uint8_t>(); }

DrawMesh normalColoredMesh(const TriangleMesh& mesh, int threads)
{
  DrawMesh drawn = plainMesh(mesh);
  drawn.face_colors = normalColors(areaVectors(drawn.vertices, drawn.faces, threads).colwise().normalized());
  return drawn;
}

DrawMesh texturedPart(const TexturedMesh& model, int atlas)
{
  DrawMesh drawn;
  std::unordered_map<std::uint64_t, int> number; // of a pair of vertex and texture coordinate
  std::vector<int> texcoord;
  std::vector<Index> faces;
  for (Index f = 0; f < model.mesh.faceCount(); ++f)
    if (model.face_atlas[f] == atlas)
      faces.push_back(f);
  drawn.faces.resize(3, faces.size());
  for (Index i = 0; i < drawn.faces.cols(); ++i)
    for (int k = 0; k < 3; ++k) {
      const int v = model.mesh.faces(k, faces[i]);
      const int t = atlas < 0 ? 0 : model.texcoord_faces(k, faces[i]);
      const std::uint64_t key = static_cast<std::uint64_t>(v) << 32 | static_cast<std::uint32_t>(t);
      const auto [at, added] = number.emplace(key, drawn.source.size());
      if (added) {
        drawn.source.push_back(v);
        texcoord.push_back(t);
      }
      drawn.faces(k, i) = at->second;
    }
  fillVertices(drawn, model.mesh);
  if (atlas >= 0)
    drawn.texcoords = model.texcoords(Eigen::all, texcoord);
  return drawn;
}
} // namespace fresco::rendering
