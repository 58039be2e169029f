// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "optimization/common/problem.h"
namespace fresco::optimization {
/// Where the places of the data contradict filtered normals and agree with normals of their own, the surface is curved:
/// faces there take the normals of their data. Filtering alone would cut round things into flat pieces.
/// @param areas   3xF area vectors
/// @param noise   deviation of the data, mean edge lengths
/// @param normals 3xF filtered ones, replaced
void followCurvedData(const OptimizationProblem& problem, const Eigen::Matrix3Xd& areas, const FacePoints& lists,
                      double noise, Eigen::Matrix3Xf& normals, int threads);
} // namespace fresco::optimization
