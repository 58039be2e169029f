// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/solver/base_solver.h"
#include "poisson/solver/dense_solver.h"
#include "poisson/solver/expected_values.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
namespace fresco::poisson {
namespace {
Eigen::VectorXd gather(const BrickLevel& level, const NodeField& field, const DenseGrid& shape)
{
  Eigen::VectorXd values = Eigen::VectorXd::Zero(shape.count());
  for (Index b = 0; b < level.size(); ++b) {
    const auto [cx, cy, cz] = level.corner(b);
    float nodes[nodes_per_brick];
    field.loadHeld(level, b, nodes);
    for (int z = 0; z < brick_nodes; ++z)
      for (int y = 0; y < brick_nodes; ++y)
        for (int x = 0; x < brick_nodes; ++x)
          values[shape.at(cx + x, cy + y, cz + z)] += nodes[nodeIndex(x, y, z)];
  }
  return values;
}

NodeField scatter(const BrickLevel& level, const DenseGrid& grid)
{
  NodeField field(level);
  for (Index b = 0; b < level.size(); ++b) {
    const auto [cx, cy, cz] = level.corner(b);
    float nodes[nodes_per_brick];
    for (int z = 0; z < brick_nodes; ++z)
      for (int y = 0; y < brick_nodes; ++y)
        for (int x = 0; x < brick_nodes; ++x)
          nodes[nodeIndex(x, y, z)] = grid.values[grid.at(cx + x, cy + y, cz + z)];
    field.store(level, b, nodes);
  }
  return field;
}

/// Mean over the samples of what chi is above what they expect.
double meanAtSamples(const DenseGrid& grid, const SampleLevel& level, const Array<float>& expected, double scale)
{
  double sum = 0, area = 0;
  for (std::size_t i = 0; i < level.samples.size(); ++i) {
    const CoarseSample& s = level.samples[i];
    sum += s.area * (interpolate(grid, s.position.cast<double>() * scale) - expectedOf(expected, i));
    area += s.area;
  }
  return sum / area;
}

template <typename Visit>
void forEachBoundaryNode(const DenseGrid& grid, const Visit& visit)
{
  for (Index z = 0; z < grid.side(); ++z)
    for (Index y = 0; y < grid.side(); ++y)
      for (Index x = 0; x < grid.side(); ++x)
        if (std::min({x, y, z}) == 0 || std::max({x, y, z}) == grid.cells)
          visit(grid.at(x, y, z));
}

/// Gives the boundary values one sign.
void closeBoundary(DenseGrid& grid)
{
  double sum = 0;
  forEachBoundaryNode(grid, [&](Index i) { sum += std::clamp(grid.values[i], -0.5, 0.5); });
  const double sign = sum < 0 ? -1 : 1;
  forEachBoundaryNode(grid,
                      [&](Index i) { grid.values[i] = sign * std::max<double>(sign * grid.values[i], clear_margin); });
}
} // namespace

NodeField solveBase(const Octree& tree, const std::vector<NodeField>& right, const std::vector<SampleLevel>& levels,
                    float point_weight, int threads)
{
  constexpr double tolerance = 1e-5; // far below the 1e-2 at which the finer depths stop
  const auto samplesFor = [&](int d) -> const SampleLevel& { return levels[std::min(d + 1, tree.depth)]; };
  DenseGrid x(2);
  for (int d = 2; d <= tree.full_depth; ++d) {
    const double scale = std::ldexp(1.0, d - tree.depth);
    const Array<float> expected = expectedValues(tree.levels[d], levels[d], samplesFor(d), tree.depth, threads);
    x = refine(x);
    DenseSystem(x.cells, samplesFor(d), expected, scale, point_weight)
        .solve(gather(tree.levels[d], right[d], x), tolerance, threads, x);
    if (d == tree.full_depth)
      x.values.array() -= meanAtSamples(x, samplesFor(d), expected, scale);
  }
  closeBoundary(x);
  return scatter(tree.levels[tree.full_depth], x);
}
} // namespace fresco::poisson
