// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <fresco/core/grouped.h>
#include <fresco/core/mesh.h>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <tuple>
namespace fresco {
namespace {
Eigen::Vector3f unitOrZero(const Eigen::Vector3d& v)
{
  const double length = v.norm();
  return length > 0 && std::isfinite(length) ? Eigen::Vector3f((v / length).cast<float>()) : Eigen::Vector3f::Zero();
}
} // namespace

void validateMesh(const TriangleMesh& mesh)
{
  const Index count = mesh.vertexCount();
  require(mesh.normals.cols() == 0 || mesh.normals.cols() == count, "mesh: ", count, " vertices, ", mesh.normals.cols(),
          " normals");
  require(mesh.colors.cols() == 0 || mesh.colors.cols() == count, "mesh: ", count, " vertices, ", mesh.colors.cols(),
          " colours");
  for (const auto& [name, values] : mesh.fields)
    require(values.size() == count, "mesh: ", count, " vertices, ", values.size(), " values of ", name);
  for (Index f = 0; f < mesh.faceCount(); ++f)
    for (int k = 0; k < 3; ++k) {
      const Index v = mesh.faces(k, f);
      require(v >= 0 && v < count, "mesh: face ", f, " names vertex ", v, " of ", count);
      require(mesh.vertices.col(v).allFinite(), "mesh: vertex ", v, " is not finite");
    }
}

Points faceNormals(const TriangleMesh& mesh, int threads)
{
  Points normals(3, mesh.faceCount());
  parallelFor(mesh.faceCount(), threads, [&](Index f) { normals.col(f) = unitOrZero(areaVector(mesh, f)); });
  return normals;
}

Points vertexNormals(const TriangleMesh& mesh, int threads)
{
  const int* vertices = mesh.faces.data();
  const Groups corners = grouped(mesh.faces.size(), mesh.vertexCount(), [&](Index i) { return vertices[i]; });
  Points normals(3, mesh.vertexCount());
  parallelFor(mesh.vertexCount(), threads, [&](Index v) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (Index i = corners.begin[v]; i < corners.begin[v + 1]; ++i)
      sum += areaVector(mesh, corners.list[i] / 3);
    normals.col(v) = unitOrZero(sum);
  });
  return normals;
}

double signedVolume(const TriangleMesh& mesh)
{
  if (mesh.faceCount() == 0)
    return 0;
  const Eigen::Vector3d center = faceCorner(mesh, 0, 0); // near the mesh, so that large coordinates cancel early
  return parallelSum(mesh.faceCount(), 0, 0.0, [&](Index f) {
    const Eigen::Vector3d a = faceCorner(mesh, f, 0) - center;
    return a.dot((faceCorner(mesh, f, 1) - center).cross(faceCorner(mesh, f, 2) - center)) / 6.0;
  });
}

double surfaceArea(const TriangleMesh& mesh)
{
  return parallelSum(mesh.faceCount(), 0, 0.0, [&](Index f) { return areaVector(mesh, f).norm() / 2.0; });
}

Faces weldedFaces(const TriangleMesh& mesh)
{
  const auto key = [&](int v) {
    return std::make_tuple(mesh.vertices(0, v), mesh.vertices(1, v), mesh.vertices(2, v));
  };
  std::vector<int> used(mesh.faces.data(), mesh.faces.data() + mesh.faces.size());
  std::sort(used.begin(), used.end(),
            [&](int a, int b) { return std::make_pair(key(a), a) < std::make_pair(key(b), b); });
  std::vector<int> first(mesh.vertexCount());
  for (std::size_t i = 0; i < used.size(); ++i)
    first[used[i]] = i > 0 && key(used[i]) == key(used[i - 1]) ? first[used[i - 1]] : used[i];
  return mesh.faces.unaryExpr([&](int v) { return first[v]; });
}

TriangleMesh removeUnreferencedVertices(const TriangleMesh& mesh)
{
  std::vector<int> renamed(mesh.vertexCount(), -1);
  for (Index i = 0; i < mesh.faces.size(); ++i)
    renamed[mesh.faces.data()[i]] = 0;
  std::vector<Index> kept;
  for (std::size_t v = 0; v < renamed.size(); ++v)
    if (renamed[v] == 0) {
      renamed[v] = kept.size();
      kept.push_back(v);
    }
  TriangleMesh result;
  result.origin = mesh.origin;
  result.vertices = mesh.vertices(Eigen::all, kept);
  if (mesh.normals.cols() > 0)
    result.normals = mesh.normals(Eigen::all, kept);
  if (mesh.colors.cols() > 0)
    result.colors = mesh.colors(Eigen::all, kept);
  for (const auto& [name, values] : mesh.fields)
    result.fields[name] = values(kept);
  result.faces = mesh.faces.unaryExpr([&](int v) { return renamed[v]; });
  return result;
}
} // namespace fresco
