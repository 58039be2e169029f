// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/pose_uncertainty.h"
#include <Eigen/Eigenvalues>
#include <cmath>
namespace fresco::registration {
namespace {
double largestDeviation(const Eigen::Matrix3d& covariance)
{
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(solver.eigenvalues()[2]);
}

// Information about the scan's centre as information about a point `middle` away from it.
Matrix6d movedInformation(const Matrix6d& information, const Eigen::Vector3d& middle)
{
  Matrix6d M = Matrix6d::Identity();
  M.topRightCorner<3, 3>() = skew(-middle);
  return M * information * M.transpose();
}
} // namespace

PoseUncertainty describeUncertainty(const Matrix6d& about_center, double rms, const PreparedScan& scan,
                                    const Eigen::Matrix3d& R_world_scan)
{
  constexpr double free_limit = 4e-3; // information of a direction / that of one in which every normal points: below,
                                      // errors in it are more than 15 times as large
  const Eigen::Vector3d middle = scan.levels.front().points.cast<double>().rowwise().mean();
  const Matrix6d information = movedInformation(about_center, R_world_scan * middle);
  const double size = scan.size;
  const double weight = information.bottomRightCorner<3, 3>().trace();
  if (!(weight > 0.0))
    return {};
  Vector6d scale;
  scale << Eigen::Vector3d::Constant(1.0 / size), Eigen::Vector3d::Ones();
  const Matrix6d scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(scaled / weight);
  const Vector6d values = solver.eigenvalues().cwiseMax(1e-9);
  const Matrix6d V = solver.eigenvectors();
  const Matrix6d covariance = V * values.cwiseInverse().asDiagonal() * V.transpose() * (rms * rms / weight);
  PoseUncertainty uncertainty;
  uncertainty.translation = largestDeviation(covariance.bottomRightCorner<3, 3>());
  uncertainty.rotation = largestDeviation(covariance.topLeftCorner<3, 3>()) / size;
  if (values[0] >= free_limit)
    return uncertainty;
  const Vector6d direction = V.col(0);
  FreeMotion motion;
  if (direction.tail<3>().norm() >= direction.head<3>().norm())
    motion.translation = direction.tail<3>().normalized();
  else
    motion.rotation = direction.head<3>().normalized();
  uncertainty.free_motion = motion;
  return uncertainty;
}
} // namespace fresco::registration
