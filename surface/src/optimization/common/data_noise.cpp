// SPDX-License-Identifier: BSD-3-Clause
#include "optimization/common/data_noise.h"
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/statistics.h>
#include <fresco/search/neighbors.h>
namespace fresco::optimization {
namespace {
constexpr Index wide_count = 24; // neighbours that a quadric is fitted to, and another to the nearer half of them
using Quadric = Eigen::Matrix<double, 6, 1>;
using Offsets = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, wide_count>;

// Variance of points across the quadric over their plane that fits them best.
double varianceAcross(const Offsets& points)
{
  const Eigen::Vector3d middle = points.rowwise().mean();
  const Offsets offsets = points.colwise() - middle;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
  axes.computeDirect(offsets * offsets.transpose());
  const double radius = std::sqrt(axes.eigenvalues()[2] / points.cols());
  if (!(radius > 0))
    return 0;
  const Offsets local = axes.eigenvectors().transpose() * offsets / radius; // across, along, along
  Eigen::Matrix<double, 6, 6> squares = Quadric::Constant(1e-9).asDiagonal();
  Quadric heights = Quadric::Zero();
  for (Index i = 0; i < local.cols(); ++i) {
    const double z = local(0, i), x = local(1, i), y = local(2, i);
    const Quadric terms{1, x, y, x * x, x * y, y * y};
    squares += terms * terms.transpose();
    heights += z * terms;
  }
  const Quadric quadric = squares.ldlt().solve(heights);
  const double left = local.row(0).squaredNorm() - quadric.dot(heights);
  return std::max(0.0, left) * radius * radius / (points.cols() - quadric.size());
}

// Neighbours of a datum, itself included, that look its way (within 60 degrees), nearest first; of those closer to each
// other than half the distance that is usual around it, the first.
Offsets neighboursApart(const PointTree& tree, const DataPoints& data, Index datum)
{
  const Eigen::Vector3f point = data.points.col(datum);
  std::vector<Neighbor> found;
  tree.nearest(point, 3 * wide_count, found);
  const double apart = 0.25 * M_PI / found.size() * found.back().squared_distance;
  Offsets chosen(3, 0);
  for (const Neighbor& neighbor : found) {
    if (data.hasNormals() && data.normals.col(neighbor.index).dot(data.normals.col(datum)) < 0.5f)
      continue;
    const Eigen::Vector3d offset = (data.points.col(neighbor.index) - point).cast<double>();
    if (chosen.cols() > 0 && (chosen.colwise() - offset).colwise().squaredNorm().minCoeff() < apart)
      continue;
    chosen.conservativeResize(Eigen::NoChange, chosen.cols() + 1);
    chosen.rightCols<1>() = offset;
    if (chosen.cols() == wide_count)
      break;
  }
  return chosen;
}
} // namespace

double dataNoise(const DataPoints& data, int threads)
{
  constexpr Index most_samples = 4000;
  const PointTree tree(data.points, threads);
  const Index step = (data.size() + most_samples - 1) / most_samples;
  std::vector<double> near((data.size() + step - 1) / step, -1), wide(near);
  parallelFor(near.size(), threads, [&](Index s) {
    const Offsets around = neighboursApart(tree, data, s * step);
    if (around.cols() < wide_count)
      return;
    near[s] = varianceAcross(around.leftCols<wide_count / 2>());
    wide[s] = varianceAcross(around);
  });
  const auto mean = [](std::vector<double>& values, Index count) { // of chi squared by its median (Wilson, Hilferty)
    const double freedom = count - Quadric::SizeAtCompileTime;
    values.erase(std::remove(values.begin(), values.end(), -1.0), values.end());
    return values.empty() ? 0.0 : median(values) / std::pow(1 - 2 / (9 * freedom), 3);
  };
  const double v = mean(near, wide_count / 2), w = mean(wide, wide_count);
  return std::sqrt(std::max(0.0, v - std::max(0.0, w - 1.5 * v))); // w is v by noise, but for chance, and 4 v by shape
}
} // namespace fresco::optimization
