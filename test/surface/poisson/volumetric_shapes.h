// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <fresco/core/point_set.h>
#include <fresco/surface/core/volumetric_reconstruction.h>
#include <random>
namespace fresco::test {
constexpr double pi = 3.14159265358979323846;

/// Points on the unit sphere, evenly spread on a spiral.
inline PointSet sphere(Index count)
{
  PointSet set;
  set.points.resize(3, count);
  for (Index i = 0; i < count; ++i) {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count), r = std::sqrt(1 - z * z);
    const double a = pi * (3 - std::sqrt(5.0)) * static_cast<double>(i);
    set.points.col(i) = Eigen::Vector3d(r * std::cos(a), r * std::sin(a), z).cast<float>();
  }
  set.normals = set.points;
  return set;
}

/// Area-weighted mean angle between the faces' normals and the directions from the origin, degrees.
inline double meanAngleToSphere(const TriangleMesh& mesh)
{
  double sum = 0, area = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const Eigen::Vector3d a = mesh.vertices.col(mesh.faces(0, f)).cast<double>(),
                          b = mesh.vertices.col(mesh.faces(1, f)).cast<double>(),
                          c = mesh.vertices.col(mesh.faces(2, f)).cast<double>();
    const Eigen::Vector3d n = (b - a).cross(c - a), out = a + b + c;
    sum += std::atan2(n.cross(out).norm(), n.dot(out)) * n.norm();
    area += n.norm();
  }
  return sum / area * 180 / pi;
}

/// Torus around the z axis with radii 1 and `tube`, sampled evenly by area.
inline PointSet torus(Index count, double tube, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> angle(0, 2 * pi), unit(0, 1);
  PointSet set;
  set.points.resize(3, count);
  set.normals.resize(3, count);
  for (Index i = 0; i < count;) {
    const double u = angle(random), v = angle(random);
    if (unit(random) * (1 + tube) > 1 + tube * std::cos(v))
      continue;
    const Eigen::Vector3d out(std::cos(u), std::sin(u), 0);
    const Eigen::Vector3d n = std::cos(v) * out + std::sin(v) * Eigen::Vector3d::UnitZ();
    set.points.col(i) = (out + tube * n).cast<float>();
    set.normals.col(i++) = n.cast<float>();
  }
  return set;
}

/// Cube of side 2 around the origin, sampled at random.
inline PointSet box(Index count, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1, 1);
  PointSet set;
  set.points.resize(3, count);
  set.normals.setZero(3, count);
  for (Index i = 0; i < count; ++i) {
    const Index axis = i % 3;
    const float side = i / 3 % 2 == 0 ? 1.f : -1.f;
    set.points.col(i) << unit(random), unit(random), unit(random);
    set.points(axis, i) = side;
    set.normals(axis, i) = side;
  }
  return set;
}

/// Both sides of a rectangle of 1 x 1.4 across the x axis, sampled at random.
inline PointSet sheet(Index count, float thickness)
{
  PointSet sides = box(3 * count, 3);
  std::vector<Index> kept;
  for (Index i = 0; i < sides.size(); i += 3)
    kept.push_back(i);
  sides = selectPoints(sides, kept);
  sides.points = Eigen::Vector3f(thickness / 2, 0.5f, 0.7f).asDiagonal() * sides.points;
  return sides;
}

/// Appends points anywhere in a cube around the origin, with any normals.
inline void addScattered(PointSet& points, Index count, float half_side)
{
  PointSet scattered = sphere(count);
  std::mt19937 random(11);
  std::uniform_real_distribution<float> place(-half_side, half_side);
  for (Index i = 0; i < count; ++i)
    scattered.points.col(i) << place(random), place(random), place(random);
  appendPoints(points, scattered);
}

/// Mean distance of the vertices to a surface given by its distance function.
template <typename Distance>
double meanDistance(const TriangleMesh& mesh, const Distance& distance)
{
  double sum = 0;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
    sum += std::abs(distance(mesh.vertices.col(v).cast<double>().eval()));
  return sum / static_cast<double>(mesh.vertexCount());
}

template <typename Distance>
double maxDistance(const TriangleMesh& mesh, const Distance& distance)
{
  double largest = 0;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
    largest = std::max(largest, std::abs(distance(mesh.vertices.col(v).cast<double>().eval())));
  return largest;
}

inline double sphereDistance(const Eigen::Vector3d& p) { return p.norm() - 1; }

inline double boxDistance(const Eigen::Vector3d& p)
{
  const Eigen::Vector3d q = p.cwiseAbs() - Eigen::Vector3d::Ones();
  return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
}

inline VolumetricOptions atDepth(int depth)
{
  VolumetricOptions options;
  options.depth = depth;
  return options;
}
} // namespace fresco::test
