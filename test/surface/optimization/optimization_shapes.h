// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cmath>
#include <fresco/core/constants.h>
#include <fresco/core/point_set.h>
#include <fresco/surface/core/normal_filtering.h>
#include <fresco/surface/core/volumetric_reconstruction.h>
#include <map>
#include <random>
#include <tuple>
namespace fresco::test {
/// Cube of side 2 around the origin as a grid of 6 n^2 quads whose corner points are drawn onto the superellipsoid
/// |x|^p + |y|^p + |z|^p = 1 within `band` of an edge: rounded edges, flat faces.
inline TriangleMesh roundedCube(int n, double rounding)
{
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3i> faces;
  std::map<std::tuple<int, int, int>, int> index;
  const auto at = [&](const Eigen::Vector3i& g) {
    const auto [place, fresh] = index.try_emplace({g[0], g[1], g[2]}, static_cast<int>(vertices.size()));
    if (fresh) {
      const Eigen::Vector3d p = 2.0 * g.cast<double>() / n - Eigen::Vector3d::Ones();
      const Eigen::Vector3d core = p.cwiseMax(rounding - 1.0).cwiseMin(1.0 - rounding), off = p - core;
      vertices.push_back((off.norm() > 0 ? Eigen::Vector3d(core + rounding * off.normalized()) : p).cast<float>());
    }
    return place->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int di, int dj) {
            Eigen::Vector3i g;
            g[axis] = side;
            g[(axis + 1) % 3] = i + di;
            g[(axis + 2) % 3] = j + dj;
            return at(g);
          };
          const int a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          if (side == n) {
            faces.emplace_back(a, b, c);
            faces.emplace_back(a, c, d);
          } else {
            faces.emplace_back(a, c, b);
            faces.emplace_back(a, d, c);
          }
        }
  TriangleMesh mesh;
  mesh.vertices.resize(3, vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v)
    mesh.vertices.col(v) = vertices[v];
  mesh.faces.resize(3, faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f)
    mesh.faces.col(f) = faces[f];
  return mesh;
}

/// The surface of the cube of side 2, at random, with Gaussian noise.
inline PointSet cubePoints(Index count, double noise, unsigned seed = 3)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1, 1);
  std::normal_distribution<float> error(0.f, noise);
  PointSet set;
  set.points.resize(3, count);
  set.normals.setZero(3, count);
  for (Index i = 0; i < count; ++i) {
    const Index axis = i % 3;
    const float side = i / 3 % 2 == 0 ? 1.f : -1.f;
    set.points.col(i) << unit(random), unit(random), unit(random);
    set.points(axis, i) = side;
    set.normals(axis, i) = side;
    for (int k = 0; k < 3 && noise > 0; ++k)
      set.points(k, i) += error(random);
  }
  return set;
}

inline double cubeDistance(const Eigen::Vector3d& p)
{
  const Eigen::Vector3d q = p.cwiseAbs() - Eigen::Vector3d::Ones();
  return std::abs(q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0));
}

/// Mean and largest distance of the vertices to the cube.
inline std::pair<double, double> cubeErrors(const TriangleMesh& mesh)
{
  double sum = 0, largest = 0;
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    const double d = cubeDistance(mesh.vertices.col(v).cast<double>());
    sum += d;
    largest = std::max(largest, d);
  }
  return {sum / static_cast<double>(mesh.vertexCount()), largest};
}

/// Share of the area whose normal is more than 20 degrees from the nearest axis.
inline double bentShare(const TriangleMesh& mesh)
{
  double bent = 0, all = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const Eigen::Vector3d a = mesh.vertices.col(mesh.faces(0, f)).cast<double>();
    const Eigen::Vector3d n = (mesh.vertices.col(mesh.faces(1, f)).cast<double>() - a)
                                  .cross(mesh.vertices.col(mesh.faces(2, f)).cast<double>() - a);
    all += n.norm();
    if (n.cwiseAbs().maxCoeff() < std::cos(20 * radians_per_degree) * n.norm())
      bent += n.norm();
  }
  return bent / all;
}
} // namespace fresco::test
