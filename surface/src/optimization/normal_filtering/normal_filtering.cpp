// SPDX-License-Identifier: BSD-3-Clause
#include <fresco/surface/core/normal_filtering.h>

#include "optimization/common/data_noise.h"
#include "optimization/common/inversion_guard.h"
#include "optimization/normal_filtering/curved_data.h"
#include "optimization/normal_filtering/edge_flips.h"
#include "optimization/normal_filtering/face_normals.h"
#include "optimization/normal_filtering/vertex_energy.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/core/robust_weights.h>
namespace fresco {
using namespace optimization;
namespace {
// The first steps find the surface and refine it. Where data contradict each other steps wander on, cut the surface into
// facets and magnify any rounding: so after the whole ones a shorter step ends it.
constexpr int most_steps = 8;
constexpr double last_part = 0.25;

void validate(const NormalFilteringOptions& options)
{
  require(options.iterations >= 1 && options.iterations <= most_steps, "optimisation: ", options.iterations,
          " iterations are not in 1..", most_steps);
  for (const double value : {options.smoothness_weight, options.tangential_weight, options.tolerance})
    require(value >= 0 && std::isfinite(value), "optimisation: weight or tolerance ", value,
            " is negative or not finite");
}

// The smoothness weight is the square of the length over which data are averaged: half the distance between data, so
// that exact ones are hardly averaged, and more with noise. Dense data need less: with the root of noise times distance
// the number of data averaged grows as noise does. Factors by measurement on
// fandisk, exact and noisy: docs/measurements/optimization.md.
TermWeights weightsFor(const OptimizationProblem& problem, double noise, const NormalFilteringOptions& options)
{
  constexpr double spacing_lengths = 0.5, noise_lengths = 14.0, noise_spacing_lengths = 7.0;
  constexpr double robust_noises = 4.0; // of Gaussian noise one datum in 16,000 is farther off
  const double spacing = problem.coverage.spacing;
  const double length = spacing_lengths * std::max(1.0, spacing) +
                        std::min(noise_lengths * noise, noise_spacing_lengths * std::sqrt(noise * spacing));
  TermWeights weights;
  weights.smoothness = options.smoothness_weight * length * length;
  weights.tangential = options.tangential_weight;
  weights.noise = noise;
  weights.robust = std::max(outlier_distance, robust_noises * noise);
  return weights;
}

// Normals of the data count where they are sharper than the field of the mesh, not where noise blurred them.
double normalWeight(double noise)
{
  constexpr double exact_weight = 2.0;   // against the normal of the same area of the mesh, which is rounded at edges
  constexpr double blurred_noise = 0.05; // mean edge lengths: 3 degrees of a normal estimated over an edge length
  const double ratio = noise / blurred_noise;
  return exact_weight * cauchyWeight(ratio * ratio);
}

// Shortens moves that would end farther from the start than a datum may be off: where data contradict each other, as on
// things not much larger than their noise, vertices would move on and draw the surface out into splinters.
void keepNearStart(const OptimizationProblem& problem, Positions& move, int threads)
{
  parallelFor(move.cols(), threads, [&](Index v) {
    const Eigen::Vector3d way = problem.x.col(v) + move.col(v) - problem.start.col(v);
    if (const double length = way.norm(); length > outlier_distance)
      move.col(v) = problem.start.col(v) + way * (outlier_distance / length) - problem.x.col(v);
  });
}

NormalFilteringStep describe(const OptimizationProblem& problem, const QuadraticEnergy& energy, const Positions& move,
                             int threads)
{
  const Positions still = Positions::Zero(3, move.cols());
  const QuadraticTerms terms = evaluate(energy, problem.graph, problem.x, move, threads);
  NormalFilteringStep step;
  step.before = evaluate(energy, problem.graph, problem.x, still, threads).sum();
  step.after = terms.sum();
  step.fit = terms.fit;
  step.smoothness = terms.smoothness;
  step.tangential = terms.tangential;
  const std::vector<char>& counts = problem.coverage.vertex;
  const double sum =
      parallelSum(move.cols(), threads, 0.0, [&](Index v) { return counts[v] ? move.col(v).squaredNorm() : 0.0; });
  step.move = std::sqrt(sum / std::max<Index>(1, std::count(counts.begin(), counts.end(), char{1})));
  return step;
}

// Makes `move` shorter where all of it would raise the energy, which is quadratic along it.
void keepEnergyDown(const OptimizationProblem& problem, const QuadraticEnergy& energy, const NormalFilteringStep& step,
                    Positions& move, int threads)
{
  const double half = evaluate(energy, problem.graph, problem.x, 0.5 * move, threads).sum() - step.before;
  const double whole = step.after - step.before; // of a t + b t^2, as is `half`
  const double linear = 4.0 * half - whole, square = whole - linear;
  move *= linear < 0.0 && square > 0.0 ? std::min(1.0, -linear / square) : 0.0;
}

// One iteration, of which `part` is done: less where it is near the tolerance, and replaced by that.
NormalFilteringStep improve(OptimizationProblem& problem, const NormalFilteringOptions& options, double& part,
                            double noise, bool is_first)
{
  constexpr int solver_rounds = 20; // of conjugate gradients: data change their faces before more would pay
  const int threads = options.threads;
  const Eigen::Matrix3Xd areas = areaVectors(problem.graph, problem.x, threads);
  const FacePoints lists = sharePoints(problem.graph, problem.x, problem.data, threads);
  NormalFilterOptions filter;
  filter.threads = threads;
  const double normal_weight = is_first ? 0.0 : normalWeight(noise); // first, creases are found without blunt normals
  Eigen::Matrix3Xf normals =
      filterNormals(problem.graph, areas, dataNormals(problem, areas, lists, normal_weight, threads), filter);
  followCurvedData(problem, areas, lists, noise, normals, threads);
  const Eigen::VectorXf residuals = dataResiduals(problem, lists, normals, threads);
  const QuadraticEnergy energy =
      makeEnergy(problem, lists, normals, residuals, weightsFor(problem, noise, options), threads);
  Positions move = solveMoves(energy, problem.graph, problem.x, solver_rounds, threads);
  keepNearStart(problem, move, threads);
  const Eigen::VectorXf left = limitMoves(problem.graph, problem.x, normals, move, threads);
  NormalFilteringStep step = describe(problem, energy, move, threads);
  if (step.after > step.before) {
    keepEnergyDown(problem, energy, step, move, threads);
    step = describe(problem, energy, move, threads);
  }
  part *= ramp(step.move, options.tolerance, 2.0 * options.tolerance + 1e-12);
  problem.x += part * move;
  const Eigen::VectorXf relaxed = static_cast<float>(part) * problem.coverage.nearness;
  relaxInverted(problem.graph, relaxed, problem.x, threads);
  relaxStuck(problem.graph, relaxed, left, problem.x, threads);
  return step;
}

// Iterations over `problem`, then rounds of edge flips; fills what `finish` does not.
class Filtering {
public:
  Filtering(OptimizationProblem& problem, const NormalFilteringOptions& options, NormalFilteringResult& result)
      : problem_(problem), options_(options), result_(result)
  {}

  void iterate(const Progress& progress)
  {
    double part = 1.0;
    for (int i = 0; i < options_.iterations && part > 0; ++i) {
      report(progress, "optimize", 0.1 + 0.75 * i / options_.iterations);
      step(part);
      part *= i + 2 < most_steps ? 1.0 : last_part;
    }
    result_.converged = result_.steps.back().move <= 2.0 * options_.tolerance;
  }

  void flip(const Progress& progress)
  {
    constexpr int rounds = 12, between = 3; // in all, and from one iteration to the next: few edges flip after these
    for (int round = 0; round < rounds; ++round) {
      report(progress, "flip", 0.85 + 0.1 * round / rounds);
      followFaces(problem_.graph, problem_.x, problem_.data, options_.threads);
      const Index flipped = flipEdges(problem_, result_.noise, options_.threads);
      result_.flipped_edges += flipped;
      if (flipped == 0)
        break;
      double part = 1.0;
      if ((round + 1) % between == 0)
        step(part);
    }
  }

private:
  void step(double& part)
  {
    if (!result_.steps.empty())
      followFaces(problem_.graph, problem_.x, problem_.data, options_.threads);
    result_.steps.push_back(improve(problem_, options_, part, result_.noise, result_.steps.empty()));
  }

  OptimizationProblem& problem_;
  const NormalFilteringOptions& options_;
  NormalFilteringResult& result_;
};
} // namespace

NormalFilteringResult filterSurface(const TriangleMesh& mesh, const PointSet& points,
                                    const NormalFilteringOptions& options, const Progress& progress)
{
  validate(options);
  report(progress, "correspondences", 0.0);
  OptimizationProblem problem = makeProblem(mesh, points, options.threads);
  NormalFilteringResult result;
  result.noise = dataNoise(problem.data, options.threads);
  Filtering filtering(problem, options, result);
  filtering.iterate(progress);
  if (options.flip)
    filtering.flip(progress);
  report(progress, "check", 0.95);
  result.noise *= problem.frame.unit;
  result.iterations = result.steps.size();
  finish(mesh, problem, options.threads, result);
  return result;
}
} // namespace fresco
