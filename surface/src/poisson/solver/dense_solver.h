// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/samples/samples.h"
#include <Eigen/Core>
#include <vector>
namespace fresco::poisson {
/// Nodes of a complete grid over the cube, `cells` a side.
struct DenseGrid {
  int cells = 0;
  Eigen::VectorXd values; ///< (cells + 1)^3, x fastest

  explicit DenseGrid(int cells_a_side) : cells(cells_a_side), values(Eigen::VectorXd::Zero(count())) {}
  Index side() const { return cells + 1; }
  Index count() const { return side() * side() * side(); }
  Index at(Index x, Index y, Index z) const { return x + side() * (y + side() * z); }
};

/// The grid with twice as many cells a side, interpolated trilinearly.
DenseGrid refine(const DenseGrid& coarse);

/// Value at a position given in cells of the grid.
double interpolate(const DenseGrid& grid, const Eigen::Vector3d& position);

/// Matrix of the screened Poisson system (see screening.h) for hat functions on a complete grid, divided by the cell
/// side; free boundary.
class DenseSystem {
public:
  /// @param samples of any depth; `scale` turns their positions into cells of the grid, and scale^2 their areas
  /// @param expected of the samples, see expectedValues()
  DenseSystem(int cells, const SampleLevel& samples, const Array<float>& expected, double scale, double point_weight);

  /// Conjugate gradients with diagonal preconditioning, from the values that `x` has, until |r| < tolerance |b|.
  /// @param b without what the samples expect
  void solve(Eigen::VectorXd b, double tolerance, int threads, DenseGrid& x) const;

private:
  void addSample(const CoarseSample& sample, float expected, double scale, double point_weight);
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y, int threads) const;
  void multiplySlice(int z, const Eigen::VectorXd& x, Eigen::VectorXd& y) const;
  DenseGrid shape_;                                 ///< values: right-hand side of the screening term
  std::vector<Eigen::Matrix<double, 8, 8>> blocks_; ///< of cells that hold samples
  std::vector<int> block_of_cell_;                  ///< -1 where there is none
  Eigen::VectorXd diagonal_;
};
} // namespace fresco::poisson
