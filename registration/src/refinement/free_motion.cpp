// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/free_motion.h"
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
namespace fresco::registration {
namespace {
struct HeldPoint {
  Eigen::Vector3d place = Eigen::Vector3d::Zero(); // about which rotations are told least
  double extent = 0.0;                             // of the surfaces around it, length
};

// Of information about a point, relative to it: the place that minimises sum w |(x - place) cross n|^2 over all matches.
HeldPoint findHeldPoint(const Matrix6d& information)
{
  const Eigen::Matrix3d A = information.topLeftCorner<3, 3>(), B = information.topRightCorner<3, 3>(),
                        C = information.bottomRightCorner<3, 3>();
  const Eigen::Vector3d v(B(2, 1) - B(1, 2), B(0, 2) - B(2, 0), B(1, 0) - B(0, 1)); // sum w n cross (x cross n)
  const Eigen::Matrix3d N = C.trace() * Eigen::Matrix3d::Identity() - C;
  HeldPoint held;
  held.place = (N + 1e-9 * C.trace() * Eigen::Matrix3d::Identity()).ldlt().solve(v); // one wall: anywhere across it
  held.extent = std::sqrt(std::max(0.0, A.trace() - held.place.dot(v)) / C.trace());
  return held;
}

// Information about a point as information about one `offset` away from it.
Matrix6d movedInformation(const Matrix6d& information, const Eigen::Vector3d& offset)
{
  Matrix6d M = Matrix6d::Identity();
  M.topRightCorner<3, 3>() = skew(-offset);
  return M * information * M.transpose();
}
} // namespace

std::optional<WeakestMotion> findWeakestMotion(const Matrix6d& about_center)
{
  const double weight = about_center.bottomRightCorner<3, 3>().trace();
  if (!(weight > 0.0))
    return {};
  const HeldPoint held = findHeldPoint(about_center);
  if (!(held.extent > 0.0))
    return {};
  const Matrix6d information = movedInformation(about_center, held.place);
  Vector6d scale;
  scale << Eigen::Vector3d::Constant(1.0 / held.extent), Eigen::Vector3d::Ones();
  const Matrix6d scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(scaled / weight);
  const Vector6d direction = solver.eigenvectors().col(0);
  WeakestMotion weakest;
  weakest.share = solver.eigenvalues()[0];
  if (direction.tail<3>().norm() >= direction.head<3>().norm())
    weakest.motion.translation = direction.tail<3>().normalized();
  else
    weakest.motion.rotation = direction.head<3>().normalized();
  return weakest;
}

std::optional<FreeMotion> findFreeMotion(const Matrix6d& about_center)
{
  constexpr double free_limit = 4e-3; // information of a direction / that of all: below, errors in it are more than 15
                                      // times as large as where every normal tells
  const std::optional<WeakestMotion> weakest = findWeakestMotion(about_center);
  return weakest && weakest->share < free_limit ? std::optional(weakest->motion) : std::nullopt;
}
} // namespace fresco::registration
