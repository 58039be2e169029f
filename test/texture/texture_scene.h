// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <fresco/texture/core/texture_reconstruction.h>
#include <functional>
#include <random>
namespace fresco::test {
/// Colour 0..255 of a place on a surface.
using Pattern = std::function<Eigen::Vector3d(const Eigen::Vector3d& point)>;

/// Smooth, different in all directions, no two places alike.
inline Eigen::Vector3d waves(const Eigen::Vector3d& p)
{
  return {128 + 90 * std::sin(3 * p.x() + 2 * p.y() + p.z()), 128 + 90 * std::sin(2 * p.y() - 3 * p.z() + 1),
          128 + 90 * std::cos(3 * p.z() - 2 * p.x() + p.y())};
}

/// Waves with detail that corners can be found in.
inline Eigen::Vector3d detailed(const Eigen::Vector3d& p)
{
  const double checks =
      std::sin(17 * p.x() + 3 * p.y()) * std::sin(13 * p.y() - 5 * p.z()) * std::sin(15 * p.z() + 4 * p.x() + 1);
  return 0.7 * waves(p).array() + 40 + 70 * std::tanh(4 * checks);
}

inline void appendBox(const Eigen::Vector3f& low, const Eigen::Vector3f& high, bool inward, TriangleMesh& mesh)
{
  const int corner[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  const int base = static_cast<int>(mesh.vertexCount()), first = static_cast<int>(mesh.faceCount());
  mesh.vertices.conservativeResize(3, base + 8);
  mesh.faces.conservativeResize(3, first + 12);
  for (int i = 0; i < 8; ++i)
    mesh.vertices.col(base + i) << (i & 1 ? high : low).x(), (i & 2 ? high : low).y(), (i & 4 ? high : low).z();
  for (int side = 0; side < 6; ++side)
    for (int half = 0; half < 2; ++half) {
      Eigen::Vector3i f(corner[side][0], corner[side][1 + half], corner[side][2 + half]);
      if (inward)
        std::swap(f[1], f[2]);
      mesh.faces.col(first + 2 * side + half) = f.array() + base;
    }
}

inline TriangleMesh cube()
{
  TriangleMesh mesh;
  appendBox({-1, -1, -1}, {1, 1, 1}, false, mesh);
  return mesh;
}

inline CameraModel camera(int width = 200, int height = 200, double focal = 260)
{
  CameraModel c;
  c.width = width;
  c.height = height;
  c.fx = c.fy = focal;
  c.cx = 0.5 * width;
  c.cy = 0.5 * height;
  return c;
}

inline Eigen::Isometry3d lookAt(const Eigen::Vector3d& eye, const Eigen::Vector3d& at)
{
  const Eigen::Vector3d z = (at - eye).normalized(),
                        x = z.cross(std::abs(z.z()) < 0.9 ? Eigen::Vector3d(0, 0, -1) : Eigen::Vector3d(0, 1, 0))
                                .normalized();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear().row(0) = x;
  T.linear().row(1) = z.cross(x);
  T.linear().row(2) = z;
  T.translation() = -(T.linear() * eye);
  return T;
}

/// Distance along the ray in units of its direction, infinite without a hit.
inline double hitDistance(const TriangleMesh& mesh, const Eigen::Vector3d& from, const Eigen::Vector3d& direction)
{
  double nearest = std::numeric_limits<double>::infinity();
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const Eigen::Vector3d a = mesh.vertices.col(mesh.faces(0, f)).cast<double>(),
                          u = mesh.vertices.col(mesh.faces(1, f)).cast<double>() - a,
                          v = mesh.vertices.col(mesh.faces(2, f)).cast<double>() - a, p = direction.cross(v);
    const double det = u.dot(p);
    if (std::abs(det) < 1e-15)
      continue;
    const Eigen::Vector3d s = (from - a) / det, q = s.cross(u);
    const double b = s.dot(p), c = q.dot(direction), t = q.dot(v);
    if (b >= 0 && c >= 0 && b + c <= 1 && t > 1e-9)
      nearest = std::min(nearest, t);
  }
  return nearest;
}

/// What a camera sees of the mesh in the colours of the pattern, times `gain`; black where it sees nothing.
inline TextureView photograph(const TriangleMesh& mesh, const Pattern& pattern, const CameraModel& model,
                              const Eigen::Isometry3d& T_camera_world, const Eigen::Vector3d& gain = {1, 1, 1})
{
  TextureView view;
  view.camera = model;
  view.T_camera_world = T_camera_world;
  view.image = Image(model.width, model.height);
  const Eigen::Isometry3d T_world_camera = T_camera_world.inverse();
  for (int y = 0; y < model.height; ++y)
    for (int x = 0; x < model.width; ++x) {
      const Eigen::Vector3d d = T_world_camera.linear() * unproject(model, {x + 0.5, y + 0.5});
      const double t = hitDistance(mesh, T_world_camera.translation() - mesh.origin, d);
      if (!std::isfinite(t))
        continue;
      const Eigen::Vector3d color = gain.cwiseProduct(pattern(T_world_camera.translation() + t * d));
      for (int c = 0; c < 3; ++c)
        view.image.pixel(x, y)[c] = static_cast<std::uint8_t>(std::lround(std::clamp(color[c], 0.0, 255.0)));
    }
  return view;
}

/// Photographs of the scene around the origin from the corners and the face centres of a cube.
inline std::vector<TextureView> photographsAround(const TriangleMesh& mesh, const Pattern& pattern, double distance = 4,
                                                  const CameraModel& model = camera())
{
  std::vector<TextureView> views;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (std::abs(x) + std::abs(y) + std::abs(z) == 1 || std::abs(x * y * z) == 1) {
          const Eigen::Vector3d eye = mesh.origin + distance * Eigen::Vector3d(x, y, z).normalized();
          views.push_back(photograph(mesh, pattern, model, lookAt(eye, mesh.origin)));
        }
  return views;
}

/// Colour of the model at a place of a face, interpolated as a graphics card does.
inline Eigen::Vector3d colorAt(const TexturedMesh& model, Index face, const Eigen::Vector3d& weights)
{
  const Image& atlas = model.atlases.at(static_cast<std::size_t>(model.face_atlas[face]));
  Eigen::Vector2d uv = Eigen::Vector2d::Zero();
  for (int k = 0; k < 3; ++k)
    uv += weights[k] * model.texcoords.col(model.texcoord_faces(k, face)).cast<double>();
  const double x = std::clamp(uv.x() * atlas.width - 0.5, 0.0, atlas.width - 1.001),
               y = std::clamp((1 - uv.y()) * atlas.height - 0.5, 0.0, atlas.height - 1.001);
  const int i = static_cast<int>(x), j = static_cast<int>(y);
  Eigen::Vector3d color = Eigen::Vector3d::Zero();
  for (int b = 0; b < 2; ++b)
    for (int a = 0; a < 2; ++a) {
      const std::uint8_t* p = atlas.pixel(i + a, j + b);
      color += (a ? x - i : 1 - x + i) * (b ? y - j : 1 - y + j) * Eigen::Vector3d(p[0], p[1], p[2]);
    }
  return color;
}

inline Eigen::Vector3d pointAt(const TriangleMesh& mesh, Index face, const Eigen::Vector3d& weights)
{
  Eigen::Vector3d p = mesh.origin;
  for (int k = 0; k < 3; ++k)
    p += weights[k] * mesh.vertices.col(mesh.faces(k, face)).cast<double>();
  return p;
}

/// visit(face, corner weights) at random places, every third of them on an edge, where colours of other charts would
/// bleed in
template <typename Visit>
void forPlaces(const TriangleMesh& mesh, int per_face, const Visit& visit)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (Index f = 0; f < mesh.faceCount(); ++f)
    for (int i = 0; i < per_face; ++i) {
      double a = unit(random), b = i % 3 == 0 ? 0 : unit(random);
      if (a + b > 1) {
        a = 1 - a;
        b = 1 - b;
      }
      visit(f, Eigen::Vector3d(1 - a - b, a, b));
    }
}

struct ColorError {
  double mean = 0, largest = 0; ///< grey levels
};

inline ColorError colorError(const TexturedMesh& model, const Pattern& pattern, int per_face = 300)
{
  ColorError error;
  Index count = 0;
  forPlaces(model.mesh, per_face, [&](Index f, const Eigen::Vector3d& weights) {
    const Eigen::Vector3d difference = colorAt(model, f, weights) - pattern(pointAt(model.mesh, f, weights));
    error.mean += difference.cwiseAbs().mean();
    error.largest = std::max(error.largest, difference.cwiseAbs().maxCoeff());
    ++count;
  });
  error.mean /= static_cast<double>(count);
  return error;
}

inline TextureOptions withThreads(int threads)
{
  TextureOptions options;
  options.threads = threads;
  return options;
}

inline bool sameAtlases(const TextureResult& a, const TextureResult& b)
{
  bool same = a.model.atlases.size() == b.model.atlases.size() && a.model.texcoords == b.model.texcoords;
  for (std::size_t i = 0; same && i < a.model.atlases.size(); ++i)
    same = a.model.atlases[i].data == b.model.atlases[i].data;
  return same;
}
} // namespace fresco::test
