// SPDX-License-Identifier: BSD-3-Clause
#include "plane_fit.h"
#include <algorithm>
#include <cmath>
namespace fresco {
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

PlaneFit fitPlane(const Moments& m)
{
  PlaneFit fit;
  if (!(m.weight > 0))
    return fit;
  const Eigen::Vector3d mean = m.first.cast<double>() / m.weight;
  fit.center = mean.cast<float>();
  Eigen::Matrix3d A;
  A << m.xx, m.xy, m.xz, m.xy, m.yy, m.yz, m.xz, m.yz, m.zz;
  A = A / m.weight - mean * mean.transpose();
  const double trace = A.trace();
  if (!(trace > 0) || !std::isfinite(trace))
    return fit;
  A /= trace; // away from underflow
  const Eigen::Vector3d values = eigenvalues(A);
  const double rounding = 1e-6; // of sums in single precision
  fit.shape = values[1] > rounding ? PlaneFit::plane : PlaneFit::line;
  fit.normal = eigenvector(A, values[fit.shape == PlaneFit::plane ? 0 : 2]).cast<float>();
  fit.curvature = static_cast<float>(std::max(0.0, values[0]));
  fit.variance = fit.curvature * static_cast<float>(trace);
  return fit;
}
} // namespace fresco
