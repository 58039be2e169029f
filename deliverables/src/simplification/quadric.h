// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
namespace fresco::deliverables {
/// Sum of squared distances from planes, each with a weight: p' A p - 2 b' p + c.
class Quadric {
public:
  void addPlane(const Eigen::Vector3d& normal, const Eigen::Vector3d& point, double weight)
  {
    // A normal that may be off by a milliradian: enough to prefer short edges on a plane, and half a millimetre a metre.
    constexpr double variance = 1e-6;
    const double distance = normal.dot(point);
    add(weight * (normal * normal.transpose() + variance * Eigen::Matrix3d::Identity()));
    b_ += weight * (distance * normal + variance * point);
    c_ += weight * (distance * distance + variance * point.squaredNorm());
    weight_ += weight;
  }

  Quadric& operator+=(const Quadric& other)
  {
    for (int i = 0; i < 6; ++i)
      a_[i] += other.a_[i];
    b_ += other.b_;
    c_ += other.c_;
    weight_ += other.weight_;
    return *this;
  }

  double weight() const { return weight_; }
  double at(const Eigen::Vector3d& p) const { return std::max(0.0, p.dot(matrix() * p) - 2 * b_.dot(p) + c_); }

  /// Share of the way from `from` to `to` at which it is least.
  double leastBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const
  {
    const Eigen::Vector3d along = to - from;
    const double curvature = along.dot(matrix() * along);
    return curvature > 0 ? std::clamp(along.dot(b_ - matrix() * from) / curvature, 0.0, 1.0) : 0.5;
  }

  /// Where it is least; in directions in which it hardly grows, beside `start`.
  Eigen::Vector3d leastNear(const Eigen::Vector3d& start) const
  {
    constexpr double stiffness = 0.01; // planes that differ by less than a tenth of a radian say nothing of their cut
    Eigen::Matrix3d A = matrix();
    const Eigen::Vector3d slope = b_ - A * start;
    A.diagonal().array() += stiffness * A.trace() + 1e-300;
    return start + A.ldlt().solve(slope);
  }

private:
  void add(const Eigen::Matrix3d& A)
  {
    const double upper[6] = {A(0, 0), A(0, 1), A(0, 2), A(1, 1), A(1, 2), A(2, 2)};
    for (int i = 0; i < 6; ++i)
      a_[i] += upper[i];
  }

  Eigen::Matrix3d matrix() const
  {
    Eigen::Matrix3d A;
    A << a_[0], a_[1], a_[2], a_[1], a_[3], a_[4], a_[2], a_[4], a_[5];
    return A;
  }

  double a_[6] = {};
  Eigen::Vector3d b_ = Eigen::Vector3d::Zero();
  double c_ = 0, weight_ = 0;
};
} // namespace fresco::deliverables
