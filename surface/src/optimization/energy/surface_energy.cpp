// SPDX-License-Identifier: BSD-3-Clause
#include <fresco/surface/core/surface_energy.h>

#include "optimization/energy/energy.h"
#include "optimization/energy/line_search.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
namespace fresco {
using namespace optimization;
namespace {
constexpr int restart_after = 50; // iterations: conjugacy is lost long before the 3 V of a quadratic energy

double dot(const Positions& a, const Positions& b, int threads)
{
  return parallelSum(a.cols(), threads, 0.0, [&](Index v) { return a.col(v).dot(b.col(v)); });
}

// Non-linear conjugate gradients (Polak, Ribiere 1969; with the restarts of Shewchuk 1994, "An introduction to the
// conjugate gradient method without the agonizing pain", 14.1).
class ConjugateGradients {
public:
  ConjugateGradients(OptimizationProblem& problem, const EnergyOptions& options)
      : problem_(problem), energy_{problem, {}, {}, options.kappa1, options.kappa2, outlier_distance, options.threads},
        threads_(options.threads)
  {
    energy_.one_rings = oneRings(problem.graph, problem.start, threads_);
    gradient_ = direction_ = Positions::Zero(3, problem.graph.vertexCount());
  }

  double kappa2() const { return energy_.kappa2; }
  void setKappa2(double kappa2)
  {
    energy_.kappa2 = kappa2;
    since_restart_ = restart_after;
  }

  EnergyStep improve()
  {
    energy_.lists = pointsOfFaces(problem_.data, problem_.graph.faceCount());
    Positions gradient(3, problem_.graph.vertexCount());
    const double before = evaluate(energy_, problem_.x, &gradient).sum(energy_);
    turn(gradient);
    const LinePoint start{0.0, before, dot(gradient_, direction_, threads_)};
    const LinePoint found = start.slope < 0.0 ? search(start) : start;
    EnergyStep step;
    step.move = rmsMove(found.step * direction_, problem_.coverage.vertex, threads_);
    problem_.x += found.step * direction_;
    const SurfaceEnergyTerms terms = evaluate(energy_, problem_.x, nullptr);
    step.fit = terms.fit;
    step.smooth = terms.smooth;
    step.topology = terms.topology;
    step.kappa2 = energy_.kappa2;
    step.before = before;
    step.after = terms.sum(energy_);
    return step;
  }

private:
  // The next direction; a negative beta, a direction that does not descend, or many iterations restart the method.
  void turn(const Positions& gradient)
  {
    const double last = dot(gradient_, gradient_, threads_);
    const double now = dot(gradient, gradient, threads_), both = dot(gradient, gradient_, threads_);
    double beta = last > 0.0 ? std::max(0.0, (now - both) / last) : 0.0;
    if (++since_restart_ > restart_after || dot(gradient, direction_, threads_) * beta >= now)
      beta = 0.0;
    if (beta == 0.0)
      since_restart_ = 0;
    direction_ = beta * direction_ - gradient;
    gradient_ = gradient;
  }

  LinePoint search(const LinePoint& start)
  {
    constexpr double first_move = 0.1; // of the vertex that moves most, mean edge lengths: turns no face over
    const double largest = direction_.colwise().norm().maxCoeff();
    double first = first_move / largest;
    if (last_gain_ < 0.0) // as large a gain as the last step's, to first order (Nocedal, Wright 2006, 3.5)
      first = std::min(first, 2.0 * last_gain_ / start.slope);
    Positions gradient(3, problem_.graph.vertexCount());
    const LinePoint found = lineSearch(start, first, [&](double step) {
      const double value = evaluate(energy_, problem_.x + step * direction_, &gradient).sum(energy_);
      return LinePoint{step, value, dot(gradient, direction_, threads_)};
    });
    last_gain_ = std::min(0.0, found.value - start.value);
    return found;
  }

  OptimizationProblem& problem_;
  SurfaceEnergy energy_;
  int threads_;
  Positions gradient_, direction_;
  int since_restart_ = restart_after;
  double last_gain_ = 0.0;
};

// Fills steps and converged.
void iterate(OptimizationProblem& problem, const EnergyOptions& options, const Progress& progress, EnergyResult& result)
{
  constexpr double resting = 5.0; // tolerances: a smaller move is rest, and kappa_2 is reduced by `reduction`, until
  constexpr double reduction = 0.5,
                   last_share = 1.0 / 64; // this share is left: less no longer keeps triangles in shape
  ConjugateGradients optimizer(problem, options);
  const double least_kappa2 = last_share * optimizer.kappa2();
  for (int i = 0; i < options.iterations && !result.converged; ++i) {
    report(progress, "optimize", 0.1 + 0.85 * i / options.iterations);
    if (i > 0)
      followFaces(problem.graph, problem.x, problem.data, options.threads);
    const EnergyStep step = optimizer.improve();
    result.steps.push_back(step);
    if (step.move > resting * options.tolerance)
      continue;
    if (optimizer.kappa2() > least_kappa2)
      optimizer.setKappa2(std::max(least_kappa2, reduction * optimizer.kappa2()));
    else
      result.converged = step.move <= options.tolerance;
  }
}
} // namespace

EnergyResult minimizeSurfaceEnergy(const TriangleMesh& mesh, const PointSet& points, const EnergyOptions& options,
                                   const Progress& progress)
{
  validateOptions(options.iterations, options.kappa1, options.kappa2, options.tolerance);
  report(progress, "correspondences", 0.0);
  OptimizationProblem problem = makeProblem(mesh, points, options.threads);
  EnergyResult result;
  iterate(problem, options, progress, result);
  report(progress, "check", 0.95);
  result.iterations = result.steps.size();
  finish(mesh, problem, options.threads, result);
  return result;
}
} // namespace fresco
