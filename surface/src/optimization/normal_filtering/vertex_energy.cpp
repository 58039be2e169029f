// SPDX-License-Identifier: BSD-3-Clause
#include "optimization/normal_filtering/vertex_energy.h"
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/robust_weights.h>
namespace fresco::optimization {
namespace {
using Eigen::Matrix3d;
using Eigen::Vector3d;

double pointWeight(const DataPoints& data, int i, double residual, const FaceTerm& term, double robust)
{
  const double ratio = residual / robust;
  double weight = gemanMcClureWeight(ratio * ratio);
  if (data.hasNormals())
    weight *= std::clamp(2.0 * data.normals.col(i).dot(term.normal), 0.0, 1.0); // all of it up to 60 degrees
  return weight;
}

void addDatum(FaceTerm& term, const Vector3d& foot, double residual, double weight)
{
  const auto add = [](float& sum, float value) { sum += value; };
  for (int k = 0; k < 3; ++k) {
    add(term.diagonal[k], weight * foot[k] * foot[k]);
    add(term.off_diagonal[k], weight * foot[k] * foot[(k + 1) % 3]);
    add(term.linear[k], weight * foot[k] * residual);
  }
  add(term.constant, weight * residual * residual);
}

// The squared gradient of a height over the triangle, times its area, is replaced by the squared differences along the
// sides, scaled to be the same for equilateral triangles: cotangents would let needles dominate.
double smoothnessWeight(const OptimizationProblem& problem, Index f)
{
  const Vector3d a = problem.x.col(problem.graph.faces(0, f)), b = problem.x.col(problem.graph.faces(1, f)),
                 c = problem.x.col(problem.graph.faces(2, f));
  const double squares = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
  return squares > 0.0 ? (b - a).cross(c - a).norm() / squares : 0.0;
}

// Per vertex, how much more the data around it are to count: the square of their mean residual against the square that
// noise alone would leave on average.
Eigen::VectorXf misfitGains(const OptimizationProblem& problem, const FacePoints& lists,
                            const Eigen::VectorXf& residuals, const TermWeights& weights, int threads)
{
  constexpr double significant = 4.0;   // two standard deviations of the mean, squared
  constexpr double greatest_gain = 30.; // bounds the condition number of the system
  Eigen::VectorXf gains = Eigen::VectorXf::Ones(problem.graph.vertexCount());
  const double noise = std::max(least_noise, weights.noise);
  parallelFor(problem.graph.vertexCount(), threads, [&](Index v) {
    double sum = 0.0, count = 0.0;
    for (const int f : facesAround(problem.graph, v))
      for (int j = lists.begin[f]; j < lists.begin[f + 1]; ++j) {
        const double e = residuals[j];
        const double share = lists.share[j] * ramp(std::abs(e), weights.robust, 0.5 * weights.robust);
        sum += share * e;
        count += share;
      }
    if (count > 0.0)
      gains[v] = std::clamp(sum * sum / (count * noise * noise * significant), 1.0, greatest_gain);
  });
  return gains;
}

struct WeightedData {
  const FacePoints& lists;
  const Eigen::VectorXf &residuals, gains; // by entry of the lists; by vertex
};

FaceTerm faceTerm(const OptimizationProblem& problem, const WeightedData& data, const TermWeights& weights, Index f,
                  FaceTerm term)
{
  const FacePoints& lists = data.lists;
  term.smoothness = weights.smoothness * smoothnessWeight(problem, f);
  double gain = 0.0;
  for (int k = 0; k < 3; ++k)
    gain += data.gains[problem.graph.faces(k, f)] / 3.0;
  for (int j = lists.begin[f]; j < lists.begin[f + 1]; ++j) {
    const int i = lists.order[j];
    const Vector3d foot = footOn(problem.graph, problem.x, f, problem.data.points.col(i).cast<double>());
    const double weight = gain * lists.share[j] * problem.coverage.point_weight[i] *
                          pointWeight(problem.data, i, data.residuals[j], term, weights.robust);
    addDatum(term, foot, data.residuals[j], weight);
  }
  return term;
}

// Projection on the directions in which no face around v says where it should be: a plane, a crease's line, nothing.
Matrix3d freeDirections(const OptimizationProblem& problem, const std::vector<FaceTerm>& faces, Index v)
{
  // A direction is free if the normals around have less than the first share of their squares in it, held from the
  // second on: two normals 11 and 20 degrees apart, weighted alike.
  constexpr double free_share = 0.01, held_share = 0.03;
  Matrix3d spread = Matrix3d::Zero();
  for (const int f : facesAround(problem.graph, v)) {
    const Vector3d n = faces[f].normal.cast<double>();
    spread += n * n.transpose();
  }
  const double trace = spread.trace();
  if (!(trace > 0.0))
    return Matrix3d::Zero();
  Eigen::SelfAdjointEigenSolver<Matrix3d> axes;
  axes.computeDirect(spread / trace);
  Matrix3d directions = Matrix3d::Zero();
  for (int k = 0; k < 3; ++k)
    directions += ramp(axes.eigenvalues()[k], held_share, free_share) * axes.eigenvectors().col(k) *
                  axes.eigenvectors().col(k).transpose();
  return directions;
}

VertexTerm vertexTerm(const OptimizationProblem& problem, const std::vector<FaceTerm>& faces,
                      const TermWeights& weights, Index v)
{
  constexpr double proximal = 1e-3; // keeps the system regular where nothing else holds a vertex; too little to be seen
  const Matrix3d directions = freeDirections(problem, faces, v);
  VertexTerm term;
  // Where data end a vertex is held the more, the farther off they are.
  const double nearness = problem.coverage.nearness[v], hold = proximal + (1.0 - nearness) / nearness;
  term.tangential = (weights.tangential * directions + hold * Matrix3d::Identity()).cast<float>();
  if (problem.graph.border[v] || edgesAround(problem.graph, v).size() == 0)
    return term;
  const Vector3d middle = meanOfNeighbours(problem.graph, problem.x, v);
  term.target = (nearness * directions * (middle - problem.x.col(v))).cast<float>();
  return term;
}
} // namespace

Eigen::VectorXf dataResiduals(const OptimizationProblem& problem, const FacePoints& lists,
                              const Eigen::Matrix3Xf& normals, int threads)
{
  Eigen::VectorXf residuals(lists.order.size());
  parallelFor(problem.graph.faceCount(), threads, [&](Index f) {
    for (int j = lists.begin[f]; j < lists.begin[f + 1]; ++j) {
      const Vector3d p = problem.data.points.col(lists.order[j]).cast<double>();
      const Vector3d offset = offsetFrom(problem.graph, problem.x, f, footOn(problem.graph, problem.x, f, p), p);
      residuals[j] = normals.col(f).cast<double>().dot(offset);
    }
  });
  return residuals;
}

Eigen::Matrix3Xf dataNormals(const OptimizationProblem& problem, const Eigen::Matrix3Xd& areas, const FacePoints& lists,
                             double normal_weight, int threads)
{
  const DataPoints& data = problem.data;
  Eigen::Matrix3Xf given = Eigen::Matrix3Xf::Zero(3, problem.graph.faceCount());
  if (!data.hasNormals() || !(normal_weight > 0.0))
    return given;
  const float float_weight = normal_weight;
  parallelFor(problem.graph.faceCount(), threads, [&](Index f) {
    for (int j = lists.begin[f]; j < lists.begin[f + 1]; ++j) {
      const auto normal = data.normals.col(lists.order[j]);
      const float facing = ramp(normal.cast<double>().dot(areas.col(f)), 0.0, 0.1 * (areas.col(f).norm() + small_area));
      given.col(f) += facing * lists.share[j] * problem.coverage.point_weight[lists.order[j]] * normal;
    }
    given.col(f) *= float_weight;
  });
  return given;
}

QuadraticEnergy makeEnergy(const OptimizationProblem& problem, const FacePoints& lists, const Eigen::Matrix3Xf& normals,
                           const Eigen::VectorXf& residuals, const TermWeights& weights, int threads)
{
  const WeightedData data{lists, residuals, misfitGains(problem, lists, residuals, weights, threads)};
  QuadraticEnergy energy;
  energy.free = problem.coverage.vertex;
  energy.faces.resize(problem.graph.faceCount());
  energy.vertices.resize(problem.graph.vertexCount());
  parallelFor(problem.graph.faceCount(), threads, [&](Index f) {
    FaceTerm term;
    term.normal = normals.col(f);
    if (problem.graph.face_edges(0, f) >= 0)
      energy.faces[f] = faceTerm(problem, data, weights, f, term);
  });
  parallelFor(problem.graph.vertexCount(), threads, [&](Index v) {
    if (energy.free[v])
      energy.vertices[v] = vertexTerm(problem, energy.faces, weights, v);
  });
  return energy;
}
} // namespace fresco::optimization
