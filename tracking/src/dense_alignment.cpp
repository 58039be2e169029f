// SPDX-License-Identifier: BSD-3-Clause
#include "dense_alignment.h"
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
namespace fresco::tracking {
namespace {
using Sums = Eigen::Matrix<double, AlignmentSums::count, 1>;

CurrentArrays arraysOf(const RgbdLevel& level, const RgbdCameras& cameras)
{
  const Pinhole K = halved(cameras.depth, level.depth_halvings), C = halved(cameras.color, level.gray_halvings);
  const Eigen::Vector3f& t = cameras.color_from_depth;
  return {level.depth.data.data(),
          level.gray.width > 0 ? level.gray.data.data() : nullptr,
          level.depth.width,
          level.depth.height,
          level.gray.width,
          level.gray.height,
          K.fx,
          K.fy,
          K.cx,
          K.cy,
          C.fx,
          C.fy,
          C.cx,
          C.cy,
          t.x(),
          t.y(),
          t.z()};
}

/// What the iterations estimate besides the pose.
struct Scales {
  double depth = 10; ///< deviation of the depth residuals, expected deviations
  double gray = 30;  ///< of the intensities, grey levels
  double gain = 1;
};

Sums sumsAt(const ReferenceLevel& reference, const CurrentArrays& current, const Linearization& at, int threads)
{
  constexpr Index chunk = 4096; // points: a multiple of 8, small enough for sums in single precision
  const auto map = [&](Index begin, Index end) {
    AlignmentSums sums;
    alignmentKernels().accumulate(reference.arrays(), begin, end, current, at, sums);
    return Sums(Eigen::Map<const Eigen::Matrix<float, AlignmentSums::count, 1>>(sums.values).cast<double>());
  };
  return parallelReduce(
      reference.padded(), threads, Sums(Sums::Zero()), map, [](const Sums& a, const Sums& b) { return Sums(a + b); },
      chunk);
}

Linearization linearize(const Eigen::Isometry3d& T_reference_current, const Scales& scales, float gate)
{
  const Eigen::Isometry3d T = T_reference_current.inverse();
  Linearization at;
  for (int i = 0; i < 9; ++i)
    at.R[i] = static_cast<float>(T.linear()(i / 3, i % 3));
  for (int i = 0; i < 3; ++i)
    at.t[i] = static_cast<float>(T.translation()[i]);
  at.gate = gate;
  at.gain = static_cast<float>(scales.gain);
  at.depth_scale = static_cast<float>(1 / (scales.depth * scales.depth));
  at.gray_scale = static_cast<float>(1 / (scales.gray * scales.gray));
  return at;
}

Matrix6d matrixOf(const Sums& sums)
{
  Matrix6d H;
  int k = 0;
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j)
      H(i, j) = H(j, i) = sums[k++];
  return H;
}

/// One step of expectation maximisation.
void updateScales(const Sums& sums, Scales& scales)
{
  constexpr double least_depth = 0.3, least_gray = 1.5; // quantisation: better than that no pixel is
  if (sums[27] > 0)
    scales.depth = std::max(least_depth, std::sqrt(sums[28] / sums[27]));
  if (sums[30] > 0)
    scales.gray = std::max(least_gray, std::sqrt(sums[31] / sums[30]));
  if (sums[32] > 0)
    scales.gain = std::clamp(sums[33] / sums[32], 0.25, 4.0);
}

Eigen::Isometry3d moved(const Eigen::Isometry3d& T, const Vector6d& x)
{
  Eigen::Isometry3d step = Eigen::Isometry3d::Identity();
  step.linear() = rotation(x.head<3>());
  step.translation() = x.tail<3>();
  Eigen::Isometry3d next = step * T;
  next.linear() = normalized(next.linear());
  return next;
}
} // namespace

DenseAlignment alignDense(const ReferenceFrame& reference, const RgbdPyramid& current, const RgbdCameras& cameras,
                          const Eigen::Isometry3d& guess, const AlignmentOptions& options)
{
  constexpr double prior = 1e-5; // of the mean stiffness: holds what neither shape nor texture holds
  DenseAlignment result;
  result.T_reference_current = guess;
  Scales scales;
  Sums sums = Sums::Zero();
  const int levels = static_cast<int>(std::min(reference.size(), current.levels.size()));
  for (int l = std::min(options.coarsest, levels - 1); l >= std::min(options.finest, levels - 1); --l) {
    const CurrentArrays arrays = arraysOf(current.levels[l], cameras);
    const float gate = l == 0 ? 0.05f : l == 1 ? 0.1f : 0.2f;          // of the depth
    const double still = 0.02 * reference[l].median_depth / arrays.fx; // metres: a fiftieth of a pixel
    for (int k = 0; k < options.iterations; ++k) {
      sums = sumsAt(reference[l], arrays, linearize(result.T_reference_current, scales, gate), options.threads);
      updateScales(sums, scales);
      Matrix6d H = matrixOf(sums);
      H.diagonal().array() += prior * H.trace() / 6 + 1e-12;
      const Vector6d x = -H.ldlt().solve(sums.segment<6>(21));
      if (!x.allFinite() || x.head<3>().norm() > 0.5)
        return {};
      result.T_reference_current = moved(result.T_reference_current, x);
      if (x.tail<3>().norm() + reference[l].median_depth * x.head<3>().norm() < still)
        break;
    }
  }
  const Matrix6d H = matrixOf(sums);
  const ReferenceLevel& last = reference[std::min(options.finest, levels - 1)];
  if (last.size() > 0 && sums[27] > 0) {
    result.information = H * (3 / std::max(1e-30, H.bottomRightCorner<3, 3>().trace()));
    result.overlap = sums[29] / last.size();
    result.agreement = sums[35] / std::max(1.0, sums[29]);
    result.rms = scales.depth;
    result.gray_rms = scales.gray;
  }
  return result;
}
} // namespace fresco::tracking
