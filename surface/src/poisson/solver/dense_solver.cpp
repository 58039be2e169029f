// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/solver/dense_solver.h"
#include "poisson/octree/select.h"
#include "poisson/solver/expected_values.h"
#include "poisson/solver/screening.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
namespace fresco::poisson {
namespace {
using Block = Eigen::Matrix<double, 8, 8>;
using Corners = Eigen::Matrix<double, 8, 1>;
/// Keeps the system regular where no screening fixes the constant; far below the stencil's entries, which are about 1.
constexpr double regularization = 1e-7;

/// Stiffness of the hat functions of a unit cell's corners (bits of the index: x, y, z).
Block stiffness()
{
  const auto mass = [](int i, int j) { return i == j ? 1.0 / 3.0 : 1.0 / 6.0; };
  const auto stiff = [](int i, int j) { return i == j ? 1.0 : -1.0; };
  Block block;
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j) {
      const int a[3] = {i & 1, i >> 1 & 1, i >> 2}, b[3] = {j & 1, j >> 1 & 1, j >> 2};
      block(i, j) = stiff(a[0], b[0]) * mass(a[1], b[1]) * mass(a[2], b[2]) +
                    mass(a[0], b[0]) * stiff(a[1], b[1]) * mass(a[2], b[2]) +
                    mass(a[0], b[0]) * mass(a[1], b[1]) * stiff(a[2], b[2]);
    }
  return block;
}

Eigen::Vector3i cellOf(const Eigen::Vector3d& position, int cells)
{
  return position.array().floor().cast<int>().max(0).min(cells - 1).matrix();
}

Corners cornerWeights(const Eigen::Vector3d& t)
{
  Corners w;
  for (int i = 0; i < 8; ++i)
    w[i] = (i & 1 ? t.x() : 1 - t.x()) * (i >> 1 & 1 ? t.y() : 1 - t.y()) * (i >> 2 ? t.z() : 1 - t.z());
  return w;
}

std::array<Index, 8> cornerNodes(const DenseGrid& grid, const Eigen::Vector3i& cell)
{
  std::array<Index, 8> nodes;
  for (int i = 0; i < 8; ++i)
    nodes[i] = grid.at(cell.x() + (i & 1), cell.y() + (i >> 1 & 1), cell.z() + (i >> 2));
  return nodes;
}

/// visit(first, count) for the segments of a vector.
template <typename Visit>
void forEachSegment(Index size, int threads, const Visit& visit)
{
  parallelRanges(
      size, threads, [&](Index begin, Index end) { visit(begin, end - begin); }, chunk_size);
}

template <typename Value, typename Function>
Value sumOfSegments(Index size, int threads, Value zero, const Function& function)
{
  return parallelReduce(
      size, threads, zero, [&](Index begin, Index end) { return function(begin, end - begin); },
      [](Value a, const Value& b) { return a += b; }, chunk_size);
}

/// Products of the residual with its preconditioned self and with itself.
struct Residual {
  double rho = 0, squared = 0;

  Residual& operator+=(const Residual& other)
  {
    rho += other.rho;
    squared += other.squared;
    return *this;
  }
};

template <typename Visit>
void forEachCell(int cells, const Visit& visit)
{
  Index index = 0;
  for (int z = 0; z < cells; ++z)
    for (int y = 0; y < cells; ++y)
      for (int x = 0; x < cells; ++x)
        visit(Eigen::Vector3i(x, y, z), index++);
}
} // namespace

DenseGrid refine(const DenseGrid& coarse)
{
  DenseGrid fine(2 * coarse.cells);
  for (Index z = 0; z < fine.side(); ++z)
    for (Index y = 0; y < fine.side(); ++y)
      for (Index x = 0; x < fine.side(); ++x) {
        double sum = 0;
        for (int i = 0; i < 8; ++i)
          sum += coarse.values[coarse.at((x + (i & 1)) / 2, (y + (i >> 1 & 1)) / 2, (z + (i >> 2)) / 2)];
        fine.values[fine.at(x, y, z)] = sum / 8;
      }
  return fine;
}

double interpolate(const DenseGrid& grid, const Eigen::Vector3d& position)
{
  const Eigen::Vector3i cell = cellOf(position, grid.cells);
  const Corners weights = cornerWeights(position - cell.cast<double>());
  const std::array<Index, 8> nodes = cornerNodes(grid, cell);
  double sum = 0;
  for (int i = 0; i < 8; ++i)
    sum += weights[i] * grid.values[nodes[i]];
  return sum;
}

DenseSystem::DenseSystem(int cells, const SampleLevel& samples, const Array<float>& expected, double scale,
                         double point_weight)
    : shape_(cells)
{
  block_of_cell_.assign(Index(cells) * cells * cells, -1);
  if (point_weight > 0)
    for (std::size_t i = 0; i < samples.samples.size(); ++i)
      addSample(samples.samples[i], expectedOf(expected, i), scale, point_weight);
  diagonal_ = Eigen::VectorXd::Constant(shape_.count(), regularization);
  const Block base = stiffness();
  forEachCell(cells, [&](const Eigen::Vector3i& cell, Index index) {
    const std::array<Index, 8> nodes = cornerNodes(shape_, cell);
    for (int i = 0; i < 8; ++i)
      diagonal_[nodes[i]] += block_of_cell_[index] < 0 ? base(i, i) : blocks_[block_of_cell_[index]](i, i);
  });
}

void DenseSystem::addSample(const CoarseSample& sample, float expected, double scale, double point_weight)
{
  const Eigen::Vector3d position = sample.position.cast<double>() * scale;
  const Eigen::Vector3i cell = cellOf(position, shape_.cells);
  int& block = block_of_cell_[cell.x() + shape_.cells * (cell.y() + shape_.cells * cell.z())];
  if (block < 0) {
    block = blocks_.size();
    blocks_.push_back(stiffness());
  }
  const Corners weights = cornerWeights(position - cell.cast<double>());
  const Corners factors = screeningFactor(sample, scale, point_weight) * weights;
  blocks_[block] += factors * weights.transpose();
  const std::array<Index, 8> nodes = cornerNodes(shape_, cell);
  for (int i = 0; i < 8; ++i)
    shape_.values[nodes[i]] += expected * factors[i];
}

/// Slices of cells in two colours: those of one colour share no node.
void DenseSystem::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y, int threads) const
{
  forEachSegment(x.size(), threads, [&](Index i, Index n) { y.segment(i, n) = regularization * x.segment(i, n); });
  for (Index color = 0; color < 2; ++color)
    parallelFor(shape_.cells / 2, shape_.cells < 16 ? 1 : threads,
                [&](Index pair) { multiplySlice(2 * pair + color, x, y); });
}

void DenseSystem::multiplySlice(int z, const Eigen::VectorXd& x, Eigen::VectorXd& y) const
{
  static const Block base = stiffness();
  Index index = Index(shape_.cells) * shape_.cells * z;
  for (int cell_y = 0; cell_y < shape_.cells; ++cell_y)
    for (int cell_x = 0; cell_x < shape_.cells; ++cell_x, ++index) {
      const std::array<Index, 8> nodes = cornerNodes(shape_, Eigen::Vector3i(cell_x, cell_y, z));
      Corners local;
      for (int i = 0; i < 8; ++i)
        local[i] = x[nodes[i]];
      const int block = block_of_cell_[index];
      const Block& matrix = block < 0 ? base : blocks_[block];
      const Corners product = matrix * local;
      for (int i = 0; i < 8; ++i)
        y[nodes[i]] += product[i];
    }
}

void DenseSystem::solve(Eigen::VectorXd b, double tolerance, int threads, DenseGrid& x) const
{
  b += shape_.values;
  constexpr int most_iterations = 300; // ends a system that rounding keeps from converging
  const Index count = shape_.count();
  Eigen::VectorXd product(count);
  multiply(x.values, product, threads);
  Eigen::VectorXd r = b - product, p = r.cwiseQuotient(diagonal_);
  Residual now{r.dot(p), r.squaredNorm()};
  const double target = tolerance * tolerance * b.squaredNorm();
  for (int i = 0; i < most_iterations && now.squared > target && now.rho > 0; ++i) {
    multiply(p, product, threads);
    const double curvature = sumOfSegments(
        count, threads, 0.0, [&](Index at, Index n) { return p.segment(at, n).dot(product.segment(at, n)); });
    const double step = now.rho / curvature;
    const Residual next = sumOfSegments(count, threads, Residual{}, [&](Index at, Index n) {
      x.values.segment(at, n) += step * p.segment(at, n);
      r.segment(at, n) -= step * product.segment(at, n);
      product.segment(at, n) = r.segment(at, n).cwiseQuotient(diagonal_.segment(at, n));
      return Residual{r.segment(at, n).dot(product.segment(at, n)), r.segment(at, n).squaredNorm()};
    });
    forEachSegment(count, threads, [&](Index at, Index n) {
      p.segment(at, n) = product.segment(at, n) + (next.rho / now.rho) * p.segment(at, n);
    });
    now = next;
  }
}
} // namespace fresco::poisson
