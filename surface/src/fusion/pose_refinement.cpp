// SPDX-License-Identifier: BSD-3-Clause
#include "fusion/pose_refinement.h"
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/rigid_motion.h>
#include <fresco/core/robust_weights.h>
namespace fresco::fusion {
namespace {
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

struct NormalEquations {
  Matrix6 H = Matrix6::Zero();
  Vector6 b = Vector6::Zero();
  double weight = 0;

  NormalEquations& operator+=(const NormalEquations& other)
  {
    H += other.H;
    b += other.b;
    weight += other.weight;
    return *this;
  }
};

/// Pixels of every fourth row and column: 19,200 of 640 x 480, some thousand times what six unknowns need.
constexpr int stride = 4;

/// A step (rotation vector, translation) about the frame's place, in the world.
NormalEquations equationsOfRow(const DistanceGrid& grid, const DepthFrame& frame, const Eigen::Isometry3d& T, int v)
{
  NormalEquations sums;
  const float reach = 0.9f * grid.truncation(); // beyond, distances are cut off
  const Eigen::Isometry3f T_world_camera = T.cast<float>();
  Index near = -1;
  for (int u = 0; u < frame.width; u += stride) {
    const float z = frame.depth(v, u);
    if (z <= 0.f)
      continue;
    const Eigen::Vector3f in_camera(z * (u - frame.cx) / frame.fx, z * (v - frame.cy) / frame.fy, z);
    const Eigen::Vector3f p = T_world_camera * in_camera;
    const auto distance = grid.at(p, near);
    if (!distance)
      continue;
    const float slope = distance->gradient.norm();
    if (!(slope > 0.3f) || std::abs(distance->value) > reach) // flatter: between two surfaces
      continue;
    const double residual = distance->value / slope, share = residual / grid.truncation();
    const double weight = tukeyWeight(share * share) / z;
    Vector6 J;
    const Eigen::Vector3d normal = (distance->gradient / slope).cast<double>();
    J << (p - T_world_camera.translation()).cast<double>().cross(normal), normal;
    for (int i = 0; i < 6; ++i) // what the factorization reads
      for (int j = 0; j <= i; ++j)
        sums.H(i, j) += weight * J[i] * J[j];
    sums.b += weight * residual * J;
    sums.weight += weight;
  }
  return sums;
}
} // namespace

Eigen::Isometry3d alignToGrid(const DistanceGrid& grid, const DepthFrame& frame,
                              const Eigen::Isometry3d& T_world_camera, const Eigen::Isometry3d& given, int threads)
{
  constexpr int iterations = 6;
  constexpr double least_pixels = 100;
  // Of the pixels' weight. A direction that few pixels hold stays as given; one that half of them hold moves by 96 %.
  constexpr double prior = 0.02;
  Eigen::Isometry3d T = T_world_camera;
  double before = 0, damping = 1;
  for (int i = 0; i < iterations; ++i) {
    const NormalEquations sums = parallelSum((frame.height + stride - 1) / stride, threads, NormalEquations{},
                                             [&](Index row) { return equationsOfRow(grid, frame, T, row * stride); });
    if (sums.weight < least_pixels)
      return T_world_camera;
    const Eigen::AngleAxisd turn(T.linear() * given.linear().transpose());
    Vector6 moved;
    moved << turn.angle() * turn.axis(), T.translation() - given.translation();
    const Matrix6 H = sums.H + prior * sums.weight * Matrix6::Identity();
    Vector6 step = -H.ldlt().solve(sums.b + prior * sums.weight * moved);
    // Where the mean of frames that disagree is flat, whole steps go too far and swing about the minimum, or grow.
    const double length = std::max(step.head<3>().norm(), step.tail<3>().norm());
    if (i > 0 && length > 0.5 * before)
      damping *= 0.5;
    before = length;
    step *= damping;
    T.linear() = rotation(step.head<3>()) * T.linear();
    T.translation() += step.tail<3>();
  }
  T.linear() = Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix();
  return T;
}
} // namespace fresco::fusion
