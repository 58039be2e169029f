// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cmath>
#include <fresco/core/mesh.h>
#include <map>
#include <vector>
/// Meshes of known geometry for tests.
namespace fresco::test {
/// Axis-aligned box from (0,0,0) to `size`, 12 faces, outward.
inline TriangleMesh box(const Eigen::Vector3f& size = Eigen::Vector3f::Ones())
{
  TriangleMesh mesh;
  mesh.vertices.resize(3, 8);
  for (int i = 0; i < 8; ++i)
    mesh.vertices.col(i) =
        Eigen::Vector3f((i & 1) ? size.x() : 0.f, (i & 2) ? size.y() : 0.f, (i & 4) ? size.z() : 0.f);
  mesh.faces.resize(3, 12);
  mesh.faces << 0, 2, 4, 5, 0, 1, 2, 6, 0, 4, 1, 3, //
      2, 3, 5, 7, 1, 5, 6, 7, 4, 6, 3, 7,           //
      1, 1, 6, 6, 4, 4, 3, 3, 2, 2, 5, 5;
  return mesh;
}

/// Sphere around the origin: an octahedron whose faces are split into 4, `rounds` times; V = 4^(rounds+1) + 2.
inline TriangleMesh sphere(float radius, int rounds)
{
  std::vector<Eigen::Vector3d> v = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<Eigen::Vector3i> f = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int round = 0; round < rounds; ++round) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [at, fresh] = middles.try_emplace(std::minmax(a, b), static_cast<int>(v.size()));
      if (fresh)
        v.push_back((v[a] + v[b]).normalized());
      return at->second;
    };
    std::vector<Eigen::Vector3i> next;
    for (const Eigen::Vector3i& t : f) {
      const int ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
      next.insert(next.end(), {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
    }
    f = next;
  }
  TriangleMesh mesh;
  mesh.vertices.resize(3, static_cast<Index>(v.size()));
  for (std::size_t i = 0; i < v.size(); ++i)
    mesh.vertices.col(static_cast<Index>(i)) = (radius * v[i]).cast<float>();
  mesh.faces.resize(3, static_cast<Index>(f.size()));
  for (std::size_t i = 0; i < f.size(); ++i)
    mesh.faces.col(static_cast<Index>(i)) = f[i];
  return mesh;
}
} // namespace fresco::test
