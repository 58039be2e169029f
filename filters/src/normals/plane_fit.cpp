// SPDX-License-Identifier: BSD-3-Clause
#include "normals/plane_fit.h"
#include <algorithm>
#include <cmath>
#include <limits>
namespace fresco::filters {
namespace {
/// Eigenvalues of a symmetric matrix, ascending; Smith 1961, "Eigenvalues of a symmetric 3 x 3 matrix".
Eigen::Vector3d eigenvalues(const Eigen::Matrix3d& A)
{
  const double mean = A.trace() / 3;
  const Eigen::Matrix3d B = A - mean * Eigen::Matrix3d::Identity();
  const double spread = std::sqrt(B.squaredNorm() / 6);
  if (!(spread > 0))
    return Eigen::Vector3d::Constant(mean);
  const double angle = std::acos(std::clamp(B.determinant() / (2 * spread * spread * spread), -1.0, 1.0)) / 3;
  const double largest = mean + 2 * spread * std::cos(angle);
  const double smallest = mean + 2 * spread * std::cos(angle + 2.0943951023931953);
  return {smallest, 3 * mean - largest - smallest, largest};
}

/// Unit vector that A - value I maps to zero: the longest cross product of two of its rows; zero if the rank is
/// below 2.
Eigen::Vector3d eigenvector(const Eigen::Matrix3d& A, double value)
{
  const Eigen::Matrix3d B = A - value * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d crosses[] = {B.col(0).cross(B.col(1)), B.col(1).cross(B.col(2)), B.col(2).cross(B.col(0))};
  const auto longest = std::max_element(std::begin(crosses), std::end(crosses),
                                        [](const auto& a, const auto& b) { return a.squaredNorm() < b.squaredNorm(); });
  return longest->normalized();
}
} // namespace

Plane fitPlane(const Moments& m, const Eigen::Vector3f& origin)
{
  Plane fit;
  fit.variance = std::numeric_limits<float>::infinity();
  fit.center = origin;
  if (!(m.weight > 0))
    return fit;
  const Eigen::Vector3d mean = Eigen::Vector3f(m.sums[0], m.sums[1], m.sums[2]).cast<double>() / m.weight;
  Eigen::Matrix3d A;
  A << m.sums[3], m.sums[4], m.sums[5], m.sums[4], m.sums[6], m.sums[7], m.sums[5], m.sums[7], m.sums[8];
  A = A / m.weight - mean * mean.transpose();
  const double trace = A.trace();
  if (!(trace > 0) || !std::isfinite(trace))
    return fit;
  fit.center += mean.cast<float>();
  A /= trace; // away from underflow
  const Eigen::Vector3d values = eigenvalues(A);
  const bool plane = values[1] > rounding_share;
  fit.normal = eigenvector(A, values[plane ? 0 : 2]).cast<float>();
  fit.curvature = plane ? std::max(0.0, values[0]) : -1.0;
  if (plane)
    fit.variance = std::max(values[0], rounding_share) * trace;
  return fit;
}
} // namespace fresco::filters
