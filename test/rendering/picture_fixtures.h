// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <cmath>
#include <fresco/rendering/picture.h>
#include <map>
#include <vector>
using namespace fresco::rendering;
namespace fresco::test {
constexpr double pi = 3.14159265358979323846;

/// Octahedron whose faces are split into four `levels` times, on the sphere of `radius` around the origin.
inline TriangleMesh sphere(float radius, int levels)
{
  std::vector<Eigen::Vector3f> vertices{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<Eigen::Vector3i> faces{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                     {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [at, added] = middles.emplace(std::minmax(a, b), static_cast<int>(vertices.size()));
      if (added)
        vertices.push_back((vertices[a] + vertices[b]).normalized());
      return at->second;
    };
    std::vector<Eigen::Vector3i> finer;
    for (const Eigen::Vector3i& f : faces) {
      const int ab = middle(f[0], f[1]), bc = middle(f[1], f[2]), ca = middle(f[2], f[0]);
      finer.insert(finer.end(), {{f[0], ab, ca}, {ab, f[1], bc}, {ca, bc, f[2]}, {ab, bc, ca}});
    }
    faces = finer;
  }
  TriangleMesh mesh;
  mesh.vertices.resize(3, static_cast<Index>(vertices.size()));
  mesh.faces.resize(3, static_cast<Index>(faces.size()));
  for (std::size_t i = 0; i < vertices.size(); ++i)
    mesh.vertices.col(static_cast<Index>(i)) = radius * vertices[i];
  for (std::size_t i = 0; i < faces.size(); ++i)
    mesh.faces.col(static_cast<Index>(i)) = faces[i];
  return mesh;
}

/// Adds an axis-aligned box whose faces show outward, or inward like those of a room.
inline void addBox(TriangleMesh& mesh, const Eigen::Vector3f& low, const Eigen::Vector3f& high, bool inward)
{
  const auto first = static_cast<int>(mesh.vertexCount());
  mesh.vertices.conservativeResize(3, first + 8);
  for (int i = 0; i < 8; ++i)
    mesh.vertices.col(first + i) << (i & 1 ? high : low).x(), (i & 2 ? high : low).y(), (i & 4 ? high : low).z();
  const int corners[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                              {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  const Index face = mesh.faceCount();
  mesh.faces.conservativeResize(3, face + 12);
  for (int i = 0; i < 12; ++i)
    mesh.faces.col(face + i) << first + corners[i][0], first + corners[i][inward ? 2 : 1],
        first + corners[i][inward ? 1 : 2];
}

/// Unit square in z = 0, x and y 0..1, facing +z, with texture coordinates equal to x and y.
inline TexturedMesh texturedSquare(const Image& atlas)
{
  TexturedMesh model;
  model.mesh.vertices.resize(3, 4);
  model.mesh.vertices << 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0;
  model.mesh.faces.resize(3, 2);
  model.mesh.faces << 0, 0, 1, 2, 2, 3;
  model.texcoords = model.mesh.vertices.topRows(2);
  model.texcoord_faces = model.mesh.faces;
  model.face_atlas = Eigen::VectorXi::Zero(2);
  model.atlases = {atlas};
  return model;
}

/// Looks at the unit square from +z, x to the right, y up; with a square picture it fills it exactly.
inline Viewpoint squareView()
{
  Viewpoint view;
  view.eye = {0.5, 0.5, 2.0};
  view.look = {0.5, 0.5, 0.0};
  view.up = {0, 1, 0};
  view.angle = 2 * std::atan(0.25) * 180 / pi;
  return view;
}

inline Viewpoint from(const Eigen::Vector3d& eye, double angle)
{
  Viewpoint view;
  view.eye = eye;
  view.angle = angle;
  return view;
}

inline PictureOptions optionsFor(Shading shading, int width = 200, int height = 150)
{
  PictureOptions options;
  options.shading = shading;
  options.width = width;
  options.height = height;
  return options;
}

inline std::array<int, 3> rgb(const Image& image, int x, int y)
{
  const std::uint8_t* const pixel = image.pixel(x, y);
  return {pixel[0], pixel[1], pixel[2]};
}

/// Largest difference of any channel.
inline int difference(const std::array<int, 3>& a, const std::array<int, 3>& b)
{
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}
} // namespace fresco::test
