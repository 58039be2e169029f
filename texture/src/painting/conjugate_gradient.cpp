// SPDX-License-Identifier: BSD-3-Clause
#include "painting/conjugate_gradient.h"
#include <fresco/core/parallel.h>
#include <numeric>
#include <utility>
namespace fresco::texture {
namespace {
using Array3 = Eigen::Array3d;

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

/// Of each row. @param f 3 numbers of a column
template <typename Function>
Array3 sumOver(Index n, int threads, const Function& f)
{
  return parallelSum(n, threads, Array3(Array3::Zero()),
                     [&](Index i) -> Array3 { return f(i).template cast<double>(); });
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
  const auto squares = [&](Index i) { return residual.col(i).array().square(); };
  const Array3 enough = sumOver(n, threads, squares) * (limits.tolerance * limits.tolerance);
  parallelFor(n, threads, [&](Index i) { direction.col(i) = preconditioned(i); });
  const auto energy = [&](Index i) { return residual.col(i).array() * preconditioned(i); };
  Array3 before = sumOver(n, threads, energy);
  for (int k = 0; k < limits.iterations && (sumOver(n, threads, squares) > enough).any(); ++k) {
    const Array3 curvature = sumOver(n, threads, [&](Index i) {
      Eigen::Vector3f sum = diagonal[i] * direction.col(i);
      for (Index e = rows.begin[i]; e < rows.begin[i + 1]; ++e)
        sum += rows.list[e].value * direction.col(rows.list[e].column);
      product.col(i) = sum;
      return (direction.col(i).array() * sum.array()).eval();
    });
    const Eigen::Array3f step = ratioOf(before, curvature).cast<float>();
    parallelFor(n, threads, [&](Index i) {
      x.col(i).array() += step * direction.col(i).array();
      residual.col(i).array() -= step * product.col(i).array();
    });
    const Array3 now = sumOver(n, threads, energy);
    const Eigen::Array3f keep = ratioOf(now, before).cast<float>();
    parallelFor(n, threads,
                [&](Index i) { direction.col(i) = (preconditioned(i) + keep * direction.col(i).array()).matrix(); });
    before = now;
  }
  return x;
}
} // namespace fresco::texture
