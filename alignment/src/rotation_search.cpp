// SPDX-License-Identifier: BSD-3-Clause
#include "rotation_search.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <fresco/core/constants.h>
#include <fresco/core/parallel.h>
#include <fresco/core/rigid_motion.h>
#include <fresco/registration/core/surface_points.h>
namespace fresco::alignment {
namespace {
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Density of the surface's normals by direction, their sign ignored, smoothed over `width`; on the sides of a cube.
class DirectionDensity {
public:
  DirectionDensity(const ScanSurface& surface, double width, int threads) : values_(3 * side_ * side_)
  {
    constexpr std::size_t most = 2000; // normals, in an order that covers all directions
    std::vector<Index> order = registration::normalSpaceOrder(surface.level());
    order.resize(std::min(most, order.size()));
    parallelFor(values_.size(), threads, [&](Index cell) {
      Vector3d direction(1, 2.0 * (cell % side_ + 0.5) / side_ - 1, 2.0 * (cell / side_ % side_ + 0.5) / side_ - 1);
      std::rotate(direction.begin(), direction.begin() + (3 - cell / (side_ * side_)) % 3, direction.end());
      direction.normalize();
      double sum = 0;
      for (const Index i : order) {
        const double cosine = direction.dot(surface.level().normals.col(i).cast<double>());
        sum += std::exp((cosine * cosine - 1) / (width * width));
      }
      values_[cell] = static_cast<float>(std::sqrt(sum)); // large walls must not outweigh all else
    });
  }

  float at(const Vector3d& direction) const
  {
    Index axis = 0;
    const double longest = direction.cwiseAbs().maxCoeff(&axis);
    const double scale = (direction[axis] < 0 ? -1 : 1) / longest;
    const auto bin = [&](double x) { return std::clamp(static_cast<int>((x * scale + 1) * side_ / 2), 0, side_ - 1); };
    const int u = bin(direction[(axis + 1) % 3]), v = bin(direction[(axis + 2) % 3]);
    return values_[(axis * side_ + v) * side_ + u];
  }

private:
  static constexpr int side_ = 64; // cells of 1.4 degrees
  std::vector<float> values_;
};

double scoreOf(const Matrix3d& R, const Eigen::Matrix3Xd& normals, const DirectionDensity& density)
{
  double sum = 0;
  for (Index i = 0; i < normals.cols(); ++i)
    sum += density.at(R * normals.col(i));
  return sum;
}

/// Super-Fibonacci spiral (Alexa 2022): rotation i of n, spread evenly.
Matrix3d spreadRotation(Index i, Index n)
{
  constexpr double phi = 1.4142135623730951, psi = 1.533751168755204288118041;
  const double s = i + 0.5, t = s / n, a = 2 * pi * s / phi, b = 2 * pi * s / psi, r = std::sqrt(t),
               q = std::sqrt(1 - t);
  return Eigen::Quaterniond(q * std::cos(b), r * std::sin(a), r * std::cos(a), q * std::sin(b)).toRotationMatrix();
}

double angleBetween(const Matrix3d& a, const Matrix3d& b) { return Eigen::AngleAxisd(a.transpose() * b).angle(); }

/// Turned about the axes in smaller and smaller steps while the score grows.
Matrix3d climbed(Matrix3d R, const Eigen::Matrix3Xd& normals, const DirectionDensity& density)
{
  double best = scoreOf(R, normals, density);
  for (double step = 4 * radians_per_degree; step > 0.4 * radians_per_degree;) {
    bool better = false;
    for (int k = 0; k < 6; ++k) {
      const Matrix3d next = rotation((k < 3 ? step : -step) * Vector3d::Unit(k % 3)) * R;
      if (const double score = scoreOf(next, normals, density); score > best) {
        best = score;
        R = next;
        better = true;
      }
    }
    step *= better ? 1 : 0.5;
  }
  return R;
}
} // namespace

std::vector<Matrix3d> findRotations(const SparseModel& model, const ScanSurface& surface, int threads)
{
  constexpr Index tried = 36000;                       // 7.5 degrees apart
  constexpr std::size_t most = 64, most_normals = 300; // a room with walls at right angles has 24
  constexpr double least = 0.5; // of what the best has more than any: half of the directions fit by chance
  constexpr Index sampled = 500;
  constexpr double coarse = 8 * radians_per_degree, fine = 3 * radians_per_degree;
  Eigen::Matrix3Xd normals(3, std::min(most_normals, model.order.size()));
  for (Index i = 0; i < normals.cols(); ++i)
    normals.col(i) = model.normals.col(model.order[i]);
  const DirectionDensity wide(surface, coarse, threads), narrow(surface, fine, threads);
  std::vector<std::pair<double, Index>> ranked(tried);
  parallelFor(tried, threads, [&](Index i) { ranked[i] = {-scoreOf(spreadRotation(i, tried), normals, wide), i}; });
  std::sort(ranked.begin(), ranked.end());
  double mean = 0; // of any rotation
  for (Index i = 0; i < sampled; ++i)
    mean += scoreOf(spreadRotation(i, sampled), normals, narrow) / sampled;
  std::vector<Matrix3d> found;
  double best = mean;
  const auto isNew = [&](const Matrix3d& R) {
    return std::none_of(found.begin(), found.end(), [&](const Matrix3d& F) { return angleBetween(F, R) < coarse; });
  };
  for (std::size_t i = 0; i < ranked.size() && found.size() < most; ++i)
    if (const Matrix3d R = spreadRotation(ranked[i].second, tried); isNew(R))
      if (const Matrix3d top = climbed(R, normals, narrow); isNew(top)) {
        const double score = scoreOf(top, normals, narrow);
        best = std::max(best, score);
        if (score - mean < least * (best - mean))
          break; // those that follow have scored less from the start
        found.push_back(top);
      }
  return found;
}
} // namespace fresco::alignment
