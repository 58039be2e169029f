// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <fresco/core/mesh.h>
#include <vector>
namespace fresco::test {
/// Rectangle [0, width] x [0, height] in the plane z = 0, normals up, cells x cells squares of two triangles.
inline TriangleMesh gridPlane(float width, float height, int cells)
{
  const int side = cells + 1;
  TriangleMesh mesh;
  mesh.vertices.resize(3, side * side);
  for (int i = 0; i < side * side; ++i)
    mesh.vertices.col(i) << width * static_cast<float>(i % side) / static_cast<float>(cells),
        height * static_cast<float>(i / side) / static_cast<float>(cells), 0.f;
  mesh.faces.resize(3, 2 * cells * cells);
  for (int i = 0; i < cells * cells; ++i) {
    const int a = i / cells * side + i % cells, b = a + 1, c = a + side, d = c + 1;
    mesh.faces.col(2 * i) << a, b, d;
    mesh.faces.col(2 * i + 1) << a, d, c;
  }
  return mesh;
}

/// `a` and `b` as one mesh.
inline TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b)
{
  TriangleMesh mesh;
  mesh.vertices.resize(3, a.vertexCount() + b.vertexCount());
  mesh.vertices << a.vertices, b.vertices;
  mesh.faces.resize(3, a.faceCount() + b.faceCount());
  mesh.faces << a.faces, (b.faces.array() + static_cast<int>(a.vertexCount())).matrix();
  return mesh;
}

inline TriangleMesh moved(TriangleMesh mesh, const Eigen::Isometry3f& motion)
{
  mesh.vertices = motion * mesh.vertices;
  return mesh;
}

/// Surface of the cube [-1, 1]^3, normals outward, six separate grids.
inline TriangleMesh gridCube(int cells)
{
  TriangleMesh face = gridPlane(2.f, 2.f, cells);
  face.vertices.colwise() += Eigen::Vector3f(-1.f, -1.f, 1.f);
  const float right = M_PI_2;
  TriangleMesh cube = face;
  using Eigen::AngleAxisf;
  using Eigen::Isometry3f;
  using Eigen::Vector3f;
  for (const float turn : {right, -right}) {
    cube = joined(cube, moved(face, Isometry3f(AngleAxisf(turn, Vector3f::UnitX()))));
    cube = joined(cube, moved(face, Isometry3f(AngleAxisf(turn, Vector3f::UnitY()))));
  }
  return joined(cube, moved(face, Isometry3f(AngleAxisf(2.f * right, Vector3f::UnitX()))));
}

/// The points at distance `radius` from the cube [-(1 - radius), 1 - radius]^3.
inline TriangleMesh roundedCube(int cells, float radius)
{
  TriangleMesh mesh = gridCube(cells);
  for (Index i = 0; i < mesh.vertexCount(); ++i) {
    const Eigen::Vector3f point = mesh.vertices.col(i);
    const Eigen::Vector3f core = point.cwiseMin(1.f - radius).cwiseMax(radius - 1.f);
    mesh.vertices.col(i) = core + radius * (point - core).normalized();
  }
  return mesh;
}

inline TriangleMesh gridSphere(int cells, float radius)
{
  TriangleMesh mesh = gridCube(cells);
  mesh.vertices.colwise().normalize();
  mesh.vertices *= radius;
  return mesh;
}
} // namespace fresco::test
