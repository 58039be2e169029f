// SPDX-License-Identifier: BSD-3-Clause
#include "draw_mesh.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <fresco/core/constants.h>
#include <fresco/core/grouped.h>
#include <fresco/core/parallel.h>
#include <fresco/core/union_find.h>
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
        around_(grouped(mesh.faces.size(), mesh.vertices.cols(), [&](Index i) { return mesh.faces.data()[i]; })),
        cosine_(std::cos(crease_angle * pi / 180))
  {}

  /// Corners around a vertex: face * 3 + k, ascending.
  Index count(Index v) const { return around_.begin[v + 1] - around_.begin[v]; }
  Index corner(Index v, Index i) const { return around_.list[around_.begin[v] + i]; }

  /// Whether an edge among the faces around `v` may be a crease.
  bool isCreased(Index v) const
  {
    const Index n = count(v);
    if (n > most_corners)
      return true;
    for (Index i = 0; i < n; ++i)
      for (Index j = 0; j < i; ++j)
        if (!sameSurface(face(v, i), face(v, j)))
          return true;
    return false;
  }

  /// Mean normal at corner number `at` of `v` over the faces on its side of all creases.
  Eigen::Vector3f normal(Index v, Index at) const
  {
    const Index own = face(v, at), n = count(v);
    if (n > most_corners)
      return directions_.col(own);
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (Index i = 0; i < n; ++i)
      if (i == at || sameSurface(own, face(v, i)))
        sum += areas_.col(face(v, i));
    return sum.norm() > 0 ? Eigen::Vector3f(sum.normalized()) : Eigen::Vector3f(directions_.col(own));
  }

private:
  static constexpr Index most_corners = 256; // beyond, comparing all pairs costs too much: such a vertex is drawn flat

  Index face(Index v, Index i) const { return corner(v, i) / 3; }
  bool sameSurface(Index f, Index g) const
  {
    return areas_.col(f).isZero(0) || areas_.col(g).isZero(0) || directions_.col(f).dot(directions_.col(g)) >= cosine_;
  }

  Points areas_, directions_;
  Groups around_;
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
    drawn.source.insert(drawn.source.end(), creased[v] ? crease.count(v) : 1, plain.source[v]);
  }
  fillVertices(drawn, mesh);
  drawn.faces.resize(3, plain.faces.cols());
  drawn.normals.resize(3, drawn.vertices.cols());
  parallelFor(count, threads, [&](Index v) {
    const bool split = creased[v];
    for (Index i = 0; i < crease.count(v); ++i) {
      const Index to = first[v] + (split ? i : 0);
      drawn.faces.data()[crease.corner(v, i)] = to;
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
  std::vector<Index>& faces = drawn.face_source;
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

std::vector<char> hangingFaces(const TriangleMesh& mesh, const Eigen::Vector3d& eye)
{
  constexpr double small = 0.1; // share
  struct Part {
    double area = 0, distance = 0; // sum over the area
    double wall = 0;               // area of the largest that it grows from
    bool isNearer(const Part& other) const { return distance * other.area < other.distance * area; }
  };
  struct Side {
    explicit Side(Index vertices) : joined(vertices), parts(vertices) {}
    Part& part(Index vertex) { return parts[joined.root(vertex)]; }

    UnionFind joined; // vertices of faces that are seen from this side
    std::vector<Part> parts;
    Part all;
  };
  std::array<Side, 2> sides{Side(mesh.vertexCount()), Side(mesh.vertexCount())};
  auto& [back, front] = sides;
  const Faces faces = weldedFaces(mesh);
  const auto to_eye = [&](Index f) { return Eigen::Vector3d(eye - mesh.origin - faceCorner(mesh, f, 0)); };
  std::vector<char> seen(faces.cols());
  for (Index f = 0; f < faces.cols(); ++f) {
    seen[f] = areaVector(mesh, f).dot(to_eye(f)) > 0;
    for (int k = 1; k < 3; ++k)
      sides[seen[f]].joined.join(faces(0, f), faces(k, f));
  }
  for (Index f = 0; f < faces.cols(); ++f)
    for (Part* part : {&sides[seen[f]].part(faces(0, f)), &sides[seen[f]].all}) {
      const double area = areaVector(mesh, f).norm();
      part->area += area;
      part->distance += area * to_eye(f).norm();
    }
  for (Index v = 0; v < mesh.vertexCount(); ++v)
    if (const Part& part = back.part(v);
        part.area > small * (back.all.area + front.all.area) && part.isNearer(front.all))
      front.part(v).wall = std::max(front.part(v).wall, part.area);
  for (Index f = 0; f < faces.cols(); ++f)
    seen[f] = seen[f] && front.part(faces(0, f)).area < small * front.part(faces(0, f)).wall;
  return seen;
}

void leaveOut(DrawMesh& drawn, const std::vector<char>& hidden)
{
  for (Index f = 0; f < drawn.faces.cols(); ++f)
    if (hidden[drawn.face_source.empty() ? f : drawn.face_source[f]])
      drawn.faces.col(f).setConstant(drawn.faces(0, f));
}
} // namespace fresco::rendering
