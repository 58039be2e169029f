// SPDX-License-Identifier: BSD-3-Clause
#include "optimization/common/edge_flips.h"
#include "optimization/common/inversion_guard.h"
#include "optimization/energy/terms.h"
#include "optimization/normal_filtering/face_normals.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
namespace fresco::optimization {
namespace {
constexpr int default_iterations = 15;
constexpr int flip_rounds = 12, flips_between = 3; // rounds of flips in all, and from one iteration to the next
constexpr double default_kappa1 = 1.0, default_kappa2 = 0.1;
constexpr int solver_rounds = 20;      // of conjugate gradients per iteration
constexpr double noise_lengths = 10.0; // averaging length per noise, both in mean edge lengths
constexpr double noise_spacing_lengths =
    7.0; // and per geometric mean of noise and distance between data: dense data average it
constexpr double spacing_lengths = 0.5; // averaging length per distance between data
constexpr double least_robust = 3.0;    // mean edge lengths: a datum this far off is judged an outlier
constexpr double robust_noises = 4.0;
constexpr double farthest =
    3.0; // mean edge lengths from where a vertex began: what is off by more is not the grid's doing
constexpr double settled_share = 0.9;  // of the step before: where steps shrink less than that
constexpr double large_move = 0.05;    // and move the vertices by more (RMS, mean edge lengths), they wander
constexpr double blurred_noise = 0.05; // mean edge lengths: from here on the normals of the data are blurred by noise
constexpr double data_normal_weight = 2.0; // of the normal of a datum, against that of the same area of the mesh

TermWeights weightsFor(const OptimizationProblem& problem, double noise, double kappa1, double kappa2)
{
  const double spacing = problem.support.spacing;
  const double length = spacing_lengths * std::max(1.0, spacing) +
                        std::min(noise_lengths * noise, noise_spacing_lengths * std::sqrt(noise * spacing));
  TermWeights weights;
  weights.slope = kappa1 * length * length;
  weights.slide = kappa2;
  weights.noise = noise;
  weights.robust = std::max(least_robust, robust_noises * noise);
  return weights;
}

// Normals of the data count where they are sharper than the field of the mesh, not where noise blurred them.
double trustInNormals(double noise)
{
  const double ratio = noise / blurred_noise;
  return data_normal_weight / (1.0 + ratio * ratio);
}

// Shortens moves that would end farther than `farthest` from the start: where data contradict each other, as on things
// not much larger than their noise, vertices would wander on and draw the surface out into splinters.
void keepNearStart(const OptimizationProblem& problem, Positions& move, int threads)
{
  parallelFor(move.cols(), threads, [&](Index v) {
    const Eigen::Vector3d way = problem.x.col(v) + move.col(v) - problem.start.col(v);
    if (const double length = way.norm(); length > farthest)
      move.col(v) = problem.start.col(v) + way * (farthest / length) - problem.x.col(v);
  });
}

OptimizationStep describe(const OptimizationProblem& problem, const QuadraticEnergy& energy, const Positions& move,
                          int threads)
{
  const Positions still = Positions::Zero(3, move.cols());
  const EnergyTerms terms = evaluate(energy, problem.graph, problem.x, move, threads);
  OptimizationStep step;
  step.before = evaluate(energy, problem.graph, problem.x, still, threads).sum();
  step.after = terms.sum();
  step.fit = terms.fit;
  step.smooth = terms.slope;
  step.topology = terms.slide;
  step.move = rmsMove(move, problem.support.vertex, threads);
  return step;
}

// One iteration. `noise` is that of the last one, and negative in the first; replaced.
OptimizationStep improve(OptimizationProblem& problem, double kappa1, double kappa2, double& noise, int threads)
{
  const Eigen::Matrix3Xd areas = areaVectors(problem.graph, problem.x, threads);
  const FacePoints lists = pointsOfFaces(problem.data, problem.graph.faceCount());
  NormalFilterOptions filter;
  filter.threads = threads;
  const double trust = noise < 0.0 ? 0.0 : trustInNormals(noise);
  const Eigen::Matrix3Xf normals =
      filterNormals(problem.graph, areas, dataNormals(problem, areas, lists, trust, threads), filter);
  const Eigen::VectorXf residuals = dataResiduals(problem, normals, threads);
  noise = noiseOf(lists, residuals);
  const QuadraticEnergy energy =
      makeEnergy(problem, lists, normals, residuals, weightsFor(problem, noise, kappa1, kappa2), threads);
  Positions move = solveMoves(energy, problem.graph, problem.x, solver_rounds, threads);
  keepNearStart(problem, move, threads);
  limitMoves(problem.graph, problem.x, normals, move, threads);
  OptimizationStep step = describe(problem, energy, move, threads);
  for (; step.after > step.before && step.move > 0.0; step = describe(problem, energy, move, threads))
    move *= 0.5;
  step.kappa2 = kappa2;
  problem.x += move;
  relaxFolds(problem.graph, problem.support.vertex, problem.x, threads);
  relaxStuck(problem.graph, problem.support.vertex, move, problem.x, threads);
  return step;
}
// Data that contradict each other, because of noise as large as the things they show, have no surface to converge to:
// further steps only cut it into facets.
bool wanders(const std::vector<OptimizationStep>& steps)
{
  const std::size_t n = steps.size();
  return n > 1 && steps[n - 1].move > large_move && steps[n - 1].move > settled_share * steps[n - 2].move;
}
} // namespace

void runBest(OptimizationProblem& problem, const SurfaceOptimizationOptions& options, const Progress& progress,
             SurfaceOptimizationResult& result)
{
  const int most = options.iterations > 0 ? options.iterations : default_iterations;
  const double kappa1 = options.kappa1 >= 0 ? options.kappa1 : default_kappa1;
  const double kappa2 = options.kappa2 >= 0 ? options.kappa2 : default_kappa2;
  double noise = -1.0;
  const auto iterate = [&] {
    if (!result.steps.empty())
      followFaces(problem.graph, problem.x, problem.data, options.threads);
    result.steps.push_back(improve(problem, kappa1, kappa2, noise, options.threads));
    result.converged = result.steps.back().move <= options.tolerance;
  };
  bool wandering = false;
  for (int i = 0; i < most && !result.converged && !wandering; ++i) {
    report(progress, "optimize", 0.1 + 0.75 * i / most);
    iterate();
    wandering = wanders(result.steps);
  }
  for (int round = 0; options.flip && round < flip_rounds; ++round) {
    report(progress, "flip", 0.85 + 0.1 * round / flip_rounds);
    followFaces(problem.graph, problem.x, problem.data, options.threads);
    const Index flipped = flipEdges(problem, noise, options.threads);
    result.flipped_edges += flipped;
    if (flipped == 0)
      break;
    if ((round + 1) % flips_between == 0 && !wandering)
      iterate();
  }
  result.noise = noise;
}
} // namespace fresco::optimization
