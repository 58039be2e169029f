// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/free_motion.h"
#include <Eigen/Eigenvalues>
namespace fresco::registration {
namespace {
// Information about the scan's centre as information about a point `middle` away from it.
Matrix6d movedInformation(const Matrix6d& information, const Eigen::Vector3d& middle)
{
  Matrix6d M = Matrix6d::Identity();
  M.topRightCorner<3, 3>() = skew(-middle);
  return M * information * M.transpose();
}
} // namespace

std::optional<FreeMotion> findFreeMotion(const Matrix6d& about_center, const PreparedScan& scan,
                                         const Eigen::Matrix3d& R_world_scan)
{
  constexpr double free_limit = 4e-3; // information of a direction / that of one in which every normal points: below,
                                      // errors in it are more than 15 times as large
  const Eigen::Vector3d middle = scan.levels.front().points.cast<double>().rowwise().mean();
  const Matrix6d information = movedInformation(about_center, R_world_scan * middle);
  const double weight = information.bottomRightCorner<3, 3>().trace();
  if (!(weight > 0.0))
    return {};
  Vector6d scale;
  scale << Eigen::Vector3d::Constant(1.0 / scan.size), Eigen::Vector3d::Ones();
  const Matrix6d scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(scaled / weight);
  if (solver.eigenvalues()[0] >= free_limit)
    return {};
  const Vector6d direction = solver.eigenvectors().col(0);
  FreeMotion motion;
  if (direction.tail<3>().norm() >= direction.head<3>().norm())
    motion.translation = direction.tail<3>().normalized();
  else
    motion.rotation = direction.head<3>().normalized();
  return motion;
}
} // namespace fresco::registration
