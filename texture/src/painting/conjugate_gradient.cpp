// SPDX-License-Identifier: BSD-3-Clause
#include "painting/conjugate_gradient.h"
#include <fresco/core/parallel.h>
#include <numeric>
#include <utility>
namespace fresco::texture {
namespace {
using Array3 = Eigen::Array3d;
using Array32 = Eigen::Array<double, 3, 2>;

struct Entry {
  int column;
  float value;
};

/// Without the diagonal.
struct Rows {
  std::vector<Index> begin; ///< N + 1
  std::vector<Entry> list;
};

Rows rowsOf(const std::vector<OffDiagonal>& entries, Index n)
{
  Rows rows{std::vector<Index>(n + 1, 0), std::vector<Entry>(2 * entries.size())};
  for (const OffDiagonal& e : entries) {
    ++rows.begin[e.i + 1];
    ++rows.begin[e.j + 1];
  }
  std::partial_sum(rows.begin.begin(), rows.begin.end(), rows.begin.begin());
  std::vector<Index> next(rows.begin.begin(), rows.begin.end() - 1);
  for (const OffDiagonal& e : entries) {
    rows.list[next[e.i]++] = {e.j, e.value};
    rows.list[next[e.j]++] = {e.i, e.value};
  }
  return rows;
}

/// 0 where there is nothing to divide.
Array3 ratioOf(const Array3& a, const Array3& b) { return (b > 0).select(a / b, 0.0); }
} // namespace

Points solveSymmetric(SymmetricMatrix matrix, const Points& right, const SolverLimits& limits)
{
  const Index n = right.cols();
  const int threads = limits.threads;
  const Eigen::VectorXf& diagonal = matrix.diagonal;
  const Rows rows = rowsOf(std::exchange(matrix.entries, {}), n);
  Points x = Points::Zero(3, n), residual = right, direction(3, n), product(3, n);
  const auto preconditioned = [&](Index i) { return residual.col(i).array() / diagonal[i]; };
  const auto norms = [&] { // squares of the residual, and in the measure of the preconditioner
    return parallelSum(n, threads, Array32(Array32::Zero()), [&](Index i) -> Array32 {
      Array32 both;
      both.col(0) = residual.col(i).array().square().cast<double>();
      both.col(1) = (residual.col(i).array() * preconditioned(i)).cast<double>();
      return both;
    });
  };
  Array32 before = norms();
  const Array3 enough = before.col(0) * (limits.tolerance * limits.tolerance);
  parallelFor(n, threads, [&](Index i) { direction.col(i) = preconditioned(i); });
  for (int k = 0; k < limits.iterations && (before.col(0) > enough).any(); ++k) {
    const Array3 curvature = parallelSum(n, threads, Array3(Array3::Zero()), [&](Index i) -> Array3 {
      Eigen::Vector3f sum = diagonal[i] * direction.col(i);
      for (Index e = rows.begin[i]; e < rows.begin[i + 1]; ++e)
        sum += rows.list[e].value * direction.col(rows.list[e].column);
      product.col(i) = sum;
      return (direction.col(i).array() * sum.array()).cast<double>();
    });
    const Eigen::Array3f step = ratioOf(before.col(1), curvature).cast<float>();
    parallelFor(n, threads, [&](Index i) {
      x.col(i).array() += step * direction.col(i).array();
      residual.col(i).array() -= step * product.col(i).array();
    });
    const Array32 now = norms();
    const Eigen::Array3f keep = ratioOf(now.col(1), before.col(1)).cast<float>();
    parallelFor(n, threads,
                [&](Index i) { direction.col(i) = (preconditioned(i) + keep * direction.col(i).array()).matrix(); });
    before = now;
  }
  return x;
}
} // namespace fresco::texture
