// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/solver/solve.h"
#include "poisson/samples/sample_ghosts.h"
#include "poisson/solver/base_solver.h"
#include "poisson/solver/expected_values.h"
#include "poisson/solver/level_system.h"
#include "poisson/solver/low_pass_filter.h"
#include "poisson/solver/transfer.h"
#include <algorithm>
#include <cmath>
#include <utility>
namespace fresco::poisson {
SampleLevels sampleLevels(SampleLevel&& finest, const Array<Eigen::Vector3f>& normals, const Octree& tree, int threads)
{
  SampleLevels levels(finest.depth + 1);
  levels.back() = std::move(finest);
  for (int d = levels.back().depth; d > 2; --d)
    levels[d - 1] = coarsen(levels[d], tree, threads, d == tree.depth ? &normals : nullptr);
  return levels;
}

namespace {
LevelSystem systemOf(const PoissonProblem& problem, int depth, const VolumetricOptions& options)
{
  const Octree& tree = problem.tree;
  const BrickLevel& level = tree.levels[depth];
  const SampleLevel& joined = problem.levels[std::min(depth + 1, tree.depth)];
  Array<float> expected = depth == tree.depth
                              ? joined.expected
                              : expectedValues(level, problem.levels[depth], joined, tree.depth, options.threads);
  return {level, joined, std::move(expected), tree.depth, options.point_weight, options.threads};
}

/// The depths at which the octree is complete.
NodeField solveComplete(const PoissonProblem& problem, const VolumetricOptions& options)
{
  auto& [tree, free_places, constraints, levels] = problem;
  const int depth = tree.full_depth;
  for (int d = 2; d <= depth; ++d)
    addCoarser(tree, d, options.threads, constraints);
  NodeField chi;
  if (tree.exchange().rank() == 0)
    chi = solveBase(tree, constraints.fine, levels, options.point_weight, options.threads);
  if (tree.partition)
    broadcastNodes(tree.exchange(), tree.levels[depth], chi);
  if (free_places.map)
    systemOf(problem, depth, options).keepFree(free_places, constraints.fine[depth], options.iterations, chi);
  return chi;
}
} // namespace

Solution solve(const PoissonProblem& problem, const VolumetricOptions& options, const Progress& progress)
{
  auto& [tree, free_places, constraints, levels] = problem;
  Solution solution;
  solution.chi.resize(tree.levels.size());
  solution.chi[tree.full_depth] = solveComplete(problem, options);
  for (int d = 2; d <= std::min(tree.full_depth, tree.depth - 1); ++d)
    levels[d] = SampleLevel();
  for (int d = tree.full_depth + 1; d <= tree.depth; ++d) {
    report(progress, "solve", 0.35 + 0.35 * (d - tree.full_depth) / (tree.depth - tree.full_depth + 1));
    addCoarser(tree, d, options.threads, constraints);
    const BrickLevel& level = tree.levels[d];
    NodeField& chi = solution.chi[d] = NodeField(level);
    interpolateLevel(tree, d, solution.chi[d - 1], options.threads,
                     [&](Index b, const float* nodes) { chi.store(level, b, nodes); });
    LevelSystem system = systemOf(problem, d, options);
    system.smooth(constraints.fine[d], options.iterations, chi);
    if (d == tree.depth) {
      const LevelSystem::Norms norms = system.residual(constraints.fine[d], chi);
      solution.residual = norms.right > 0 ? std::sqrt(norms.residual / norms.right) : 0;
    }
    system.keepFree(free_places, constraints.fine[d], options.iterations, chi);
    if (d < tree.depth)
      system.addMultiplierUpdate(chi, constraints.own[d]);
    LowPassFilter(level, levels[std::min(d + 1, tree.depth)], tree.depth, options.threads)
        .apply(chi, constraints.fine[d]);
    constraints.fine[d] = NodeField();
    if (d < tree.depth)
      levels[d] = SampleLevel();
  }
  return solution;
}
} // namespace fresco::poisson
