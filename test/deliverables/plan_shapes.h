// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <fresco/core/mesh.h>
#include <fresco/core/point_set.h>
#include <random>
#include <vector>
namespace fresco::test {
/// Rectangles that are put together to rooms, seen from inside.
class RoomBuilder {
public:
  /// a, b, c, d counter-clockwise from the free side
  void quad(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, const Eigen::Vector3d& d)
  {
    const int first = static_cast<int>(vertices_.size());
    vertices_.insert(vertices_.end(), {a, b, c, d});
    faces_.push_back({first, first + 1, first + 2});
    faces_.push_back({first, first + 2, first + 3});
  }

  /// Upright wall from `a` to `b` between two heights, the room on its left.
  void wall(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double low, double high)
  {
    if (high > low && (b - a).norm() > 0)
      quad(at(b, low), at(a, low), at(a, high), at(b, high));
  }

  /// The same with a hole from `begin` to `end` metres along it, between `sill` and `head`.
  void openWall(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double high, const std::vector<double>& hole)
  {
    const Eigen::Vector2d d = (b - a).normalized(), p = a + hole[0] * d, q = a + hole[1] * d;
    wall(a, p, 0, high);
    wall(p, q, 0, hole[2]);
    wall(p, q, hole[3], high);
    wall(q, b, 0, high);
  }

  /// Floor and ceiling over a convex outline.
  void slabs(const std::vector<Eigen::Vector2d>& outline, double high)
  {
    for (std::size_t k = 1; k + 1 < outline.size(); ++k) {
      quad(at(outline[0], 0), at(outline[k], 0), at(outline[k + 1], 0), at(outline[k + 1], 0));
      quad(at(outline[0], high), at(outline[k + 1], high), at(outline[k], high), at(outline[k], high));
    }
  }

  void room(const std::vector<Eigen::Vector2d>& outline, double high)
  {
    for (std::size_t k = 0; k < outline.size(); ++k)
      wall(outline[k], outline[(k + 1) % outline.size()], 0, high);
    slabs(outline, high);
  }

  TriangleMesh mesh() const
  {
    TriangleMesh mesh;
    mesh.vertices.resize(3, vertices_.size());
    mesh.faces.resize(3, faces_.size());
    for (std::size_t i = 0; i < vertices_.size(); ++i)
      mesh.vertices.col(i) = vertices_[i].cast<float>();
    for (std::size_t f = 0; f < faces_.size(); ++f)
      mesh.faces.col(f) = faces_[f];
    return mesh;
  }

private:
  static Eigen::Vector3d at(const Eigen::Vector2d& p, double z) { return {p.x(), p.y(), z}; }
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Eigen::Vector3i> faces_;
};

/// Two rooms of 4 x 3 and 3 x 3 m beside a wall of 10 cm with a door in it; a window in the first one.
inline TriangleMesh twoRooms()
{
  const double high = 2.6;
  RoomBuilder b;
  b.openWall({0, 0}, {4, 0}, high, {1, 2.5, 0.9, 2.1});
  b.openWall({4, 0}, {4, 3}, high, {1, 1.9, 0, 2});
  b.wall({4, 3}, {0, 3}, 0, high);
  b.wall({0, 3}, {0, 0}, 0, high);
  b.slabs({{0, 0}, {4, 0}, {4, 3}, {0, 3}}, high);
  b.wall({4.1, 0}, {7.1, 0}, 0, high);
  b.wall({7.1, 0}, {7.1, 3}, 0, high);
  b.wall({7.1, 3}, {4.1, 3}, 0, high);
  b.openWall({4.1, 3}, {4.1, 0}, high, {1.1, 2, 0, 2});
  b.slabs({{4.1, 0}, {7.1, 0}, {7.1, 3}, {4.1, 3}}, high);
  b.quad({4, 1, 0}, {4.1, 1, 0}, {4.1, 1.9, 0}, {4, 1.9, 0}); // the sill of the door
  return b.mesh();
}

inline double areaOf(const std::vector<Eigen::Vector2d>& outline)
{
  double twice = 0;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Eigen::Vector2d &a = outline[k], &b = outline[(k + 1) % outline.size()];
    twice += a.x() * b.y() - b.x() * a.y();
  }
  return twice / 2;
}

/// Points spread evenly over a mesh, off it by a normal deviation in metres.
inline PointSet scanOf(const TriangleMesh& mesh, int per_square_metre, double noise)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<float> share(0, 1);
  std::normal_distribution<float> off(0, static_cast<float>(noise));
  std::vector<Eigen::Vector3f> points;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const Eigen::Vector3d normal = areaVector(mesh, f);
    const double count = normal.norm() / 2 * per_square_metre + share(random);
    for (int k = 0; k < static_cast<int>(count); ++k) {
      float u = share(random), v = share(random);
      if (u + v > 1)
        u = 1 - u, v = 1 - v;
      const Eigen::Vector3f a = mesh.vertices.col(mesh.faces(0, f)), b = mesh.vertices.col(mesh.faces(1, f)),
                            c = mesh.vertices.col(mesh.faces(2, f));
      points.push_back(a + u * (b - a) + v * (c - a) + off(random) * normal.normalized().cast<float>());
    }
  }
  PointSet cloud;
  cloud.points.resize(3, points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    cloud.points.col(i) = points[i];
  return cloud;
}
} // namespace fresco::test
