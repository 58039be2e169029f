// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "test_data.h"
#include <Eigen/Geometry>
#include <cmath>
#include <fresco/core/point_set.h>
#include <limits>
#include <random>
/// Points on surfaces of known normals.
namespace fresco::test {
inline constexpr float nan = std::numeric_limits<float>::quiet_NaN();

struct Cloud {
  Points points, normals;
};

inline Points randomPoints(Index count, unsigned seed, float low = -1, float high = 1)
{
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> uniform(low, high);
  return Points::NullaryExpr(3, count, [&] { return uniform(generator); });
}

/// Gaussian noise of all coordinates.
inline Points withNoise(const Points& points, float deviation, unsigned seed)
{
  std::mt19937 generator(seed);
  std::normal_distribution<float> normal(0, deviation);
  return points + Points::NullaryExpr(3, points.cols(), [&] { return normal(generator); });
}

/// Square of side 2 in the plane z = 0.
inline Cloud flatSquare(Index count, unsigned seed)
{
  Cloud cloud{randomPoints(count, seed), Points::Zero(3, count)};
  cloud.points.row(2).setZero();
  cloud.normals.row(2).setOnes();
  return cloud;
}

inline Cloud unitSphere(Index count, unsigned seed)
{
  std::mt19937 generator(seed);
  std::normal_distribution<float> normal;
  Points points = Points::NullaryExpr(3, count, [&] { return normal(generator); });
  points.colwise().normalize();
  return {points, points};
}

/// Surface of the cube from -1 to 1.
inline Cloud cube(Index count, unsigned seed)
{
  std::mt19937 generator(seed);
  std::uniform_int_distribution<int> side(0, 5);
  Cloud cloud{randomPoints(count, seed + 1), Points::Zero(3, count)};
  for (Index i = 0; i < count; ++i) {
    const int s = side(generator);
    cloud.points(s / 2, i) = cloud.normals(s / 2, i) = s % 2 ? 1.f : -1.f;
  }
  return cloud;
}

/// Distance of a point of the cube to the nearest edge.
inline float edgeDistance(const Eigen::Vector3f& point)
{
  Eigen::Vector3f gaps = (1 - point.array().abs()).abs();
  std::sort(gaps.data(), gaps.data() + 3);
  return gaps[1];
}

/// Degrees, 0..180; 180 for NaN.
inline float angleBetween(const Eigen::Vector3f& a, const Eigen::Vector3f& b)
{
  const float angle = std::atan2(a.cross(b).norm(), a.dot(b)) * 57.29578f;
  return std::isfinite(angle) ? angle : 180.f;
}

inline double meanAngle(const Points& a, const Points& b)
{
  double sum = 0;
  for (Index i = 0; i < a.cols(); ++i)
    sum += angleBetween(a.col(i), b.col(i));
  return sum / static_cast<double>(a.cols());
}

/// A turn about an odd axis and a shift.
inline Eigen::Isometry3f someMotion()
{
  Eigen::Isometry3f motion = Eigen::Isometry3f::Identity();
  motion.rotate(Eigen::AngleAxisf(1.1f, Eigen::Vector3f(1, -2, 0.5f).normalized()));
  motion.pretranslate(Eigen::Vector3f(3, -1, 2));
  return motion;
}

/// Equal bits, NaN equal to NaN.
template <typename Matrix>
bool same(const Matrix& a, const Matrix& b)
{
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         ((a.array() == b.array()) || (a.array().isNaN() && b.array().isNaN())).all();
}
} // namespace fresco::test
