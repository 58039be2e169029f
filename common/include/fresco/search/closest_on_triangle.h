// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
namespace fresco {
struct PointOnTriangle {
  Eigen::Vector3d point;
  double squared_distance;
};

/// Point of the segment a-b that lies closest to p; a = b is a point.
inline PointOnTriangle closestOnSegment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  const Eigen::Vector3d ab = b - a;
  const double along = ab.dot(p - a), length2 = ab.squaredNorm();
  const Eigen::Vector3d point = along <= 0.0 ? a : along >= length2 ? b : Eigen::Vector3d(a + (along / length2) * ab);
  return {point, (p - point).squaredNorm()};
}

/// Point of the triangle a-b-c that lies closest to p, or a squared distance above `bound` where the triangle lies
/// farther away than that. The foot of the perpendicular is found through the normal, not through barycentric
/// coordinates, which lose all digits on needles. A triangle flatter than 1e-10 of its length is taken for its three
/// edges.
inline PointOnTriangle closestOnTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                         const Eigen::Vector3d& c, double bound)
{
  const Eigen::Vector3d ab = b - a, bc = c - b, ca = a - c, ap = p - a;
  const Eigen::Vector3d normal = ab.cross(bc);
  const double normal2 = normal.squaredNorm(), height = normal.dot(ap);
  if (height * height > bound * normal2 * (1.0 + 1e-12))
    return {a, std::numeric_limits<double>::infinity()}; // the plane alone is too far away
  const double longest2 = std::max({ab.squaredNorm(), bc.squaredNorm(), ca.squaredNorm()});
  const bool flat = !(normal2 > 1e-20 * longest2 * longest2);
  const bool beyond_ab = flat || normal.dot(ab.cross(ap)) < 0.0;
  const bool beyond_bc = flat || normal.dot(bc.cross(p - b)) < 0.0;
  const bool beyond_ca = flat || normal.dot(ca.cross(p - c)) < 0.0;
  if (!beyond_ab && !beyond_bc && !beyond_ca) {
    // The height is the same from each corner but for rounding; from a corner at p it is exactly zero.
    const double smallest = std::min({std::abs(height), std::abs(normal.dot(p - b)), std::abs(normal.dot(p - c))});
    return {p - (height / normal2) * normal, smallest * smallest / normal2};
  }
  // Outside of a convex figure the closest point lies on an edge that faces the query.
  PointOnTriangle best{a, std::numeric_limits<double>::infinity()};
  const auto improve = [&](bool facing, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    if (!facing)
      return;
    const PointOnTriangle candidate = closestOnSegment(p, from, to);
    if (candidate.squared_distance < best.squared_distance)
      best = candidate;
  };
  improve(beyond_ab, a, b);
  improve(beyond_bc, b, c);
  improve(beyond_ca, c, a);
  return best;
}
} // namespace fresco
