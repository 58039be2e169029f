// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "common/shapes.h"
#include <fresco/core/textured_mesh.h>
#include <random>
namespace fresco::test {
/// A square of side 2 around (1, 1, 0) of 2 n n faces, turned up.
inline TriangleMesh square(int n)
{
  TriangleMesh mesh;
  mesh.vertices.resize(3, (n + 1) * (n + 1));
  mesh.faces.resize(3, 2 * n * n);
  for (int y = 0, f = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) {
      const int a = y * (n + 1) + x;
      mesh.vertices.col(a) << 2.f * x / n, 2.f * y / n, 0;
      if (x == n || y == n)
        continue;
      mesh.faces.col(f++) << a, a + 1, a + n + 2;
      mesh.faces.col(f++) << a, a + n + 2, a + n + 1;
    }
  return mesh;
}

/// The square in two charts, left and right of x = 1, side by side with a gap; texture coordinates are affine in x, y.
inline TexturedMesh texturedSquare(int n)
{
  TexturedMesh model;
  model.mesh = square(n);
  const Index vertices = model.mesh.vertexCount(), faces = model.mesh.faceCount();
  model.texcoords.resize(2, 2 * vertices);
  for (Index v = 0; v < vertices; ++v)
    for (int chart = 0; chart < 2; ++chart)
      model.texcoords.col(2 * v + chart) << 0.4f * model.mesh.vertices(0, v) + 0.1f * chart,
          0.45f * model.mesh.vertices(1, v);
  model.texcoord_faces.resize(3, faces);
  model.face_atlas = Eigen::VectorXi::Zero(faces);
  for (Index f = 0; f < faces; ++f) {
    float sum = 0;
    for (const int v : model.mesh.faces.col(f))
      sum += model.mesh.vertices(0, v);
    model.texcoord_faces.col(f) = 2 * model.mesh.faces.col(f).array() + (sum > 3 ? 1 : 0);
  }
  model.atlases = {Image(64, 64, 3, 100)};
  return model;
}

/// Largest difference of a corner's texture coordinates from what its place asks for in texturedSquare().
inline float textureError(const TexturedMesh& model)
{
  float most = 0;
  for (Index f = 0; f < model.mesh.faceCount(); ++f) {
    float sum = 0;
    for (const int v : model.mesh.faces.col(f))
      sum += model.mesh.vertices(0, v);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3f at = model.mesh.vertices.col(model.mesh.faces(k, f));
      const Eigen::Vector2f wanted(0.4f * at.x() + (sum > 3 ? 0.1f : 0.f), 0.45f * at.y());
      most = std::max(most, (model.texcoords.col(model.texcoord_faces(k, f)) - wanted).cwiseAbs().maxCoeff());
    }
  }
  return most;
}

/// Moves each vertex by a normal deviate times `deviation` along each axis.
inline TriangleMesh withNoise(TriangleMesh mesh, float deviation)
{
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0, deviation);
  for (float& value : mesh.vertices.reshaped())
    value += noise(random);
  return mesh;
}
} // namespace fresco::test
