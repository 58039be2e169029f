// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "optimization/common/problem.h"
#include "optimization/normal_filtering/vertex_solver.h"
namespace fresco::optimization {
struct TermWeights {
  double smoothness = 1; ///< weight of the squared slopes: squared length over which data are averaged
  double tangential = 1; ///< weight of sliding along the surface towards the middle of the neighbours
  double noise = 0;      ///< deviation of the data, mean edge lengths: misfits that it does not explain get more weight
  double robust = 1;     ///< residual at which a datum has lost three quarters of its weight, mean edge lengths
};

/// Distance of each datum from each of its faces along the face's target normal, in the order of `lists`; mean edge
/// lengths.
/// @param normals 3xF
Eigen::VectorXf dataResiduals(const OptimizationProblem& problem, const FacePoints& lists,
                              const Eigen::Matrix3Xf& normals, int threads);

/// Mean normal of the data of each face that face its way, as long as the area that they stand for times
/// `normal_weight`.
/// @param areas 3xF area vectors
Eigen::Matrix3Xf dataNormals(const OptimizationProblem& problem, const Eigen::Matrix3Xd& areas, const FacePoints& lists,
                             double normal_weight, int threads);

QuadraticEnergy makeEnergy(const OptimizationProblem& problem, const FacePoints& lists, const Eigen::Matrix3Xf& normals,
                           const Eigen::VectorXf& residuals, const TermWeights& weights, int threads);
} // namespace fresco::optimization
