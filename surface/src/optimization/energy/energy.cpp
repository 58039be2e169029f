// SPDX-License-Identifier: BSD-3-Clause
#include "optimization/energy/energy.h"
#include <Eigen/Geometry>
#include <cmath>
#include <fresco/core/parallel.h>
namespace fresco::optimization {
namespace {
using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr double potential_scale = 0.1; // eps of psi, chord of unit normals: angles below 6 degrees count as noise

// psi'(t) / t
double potentialSlope(double difference)
{
  return 0.5 * std::pow(difference * difference + potential_scale * potential_scale, -0.75);
}

// Normal of a triangle, shorter than 1 where it has hardly any area, so that needles do not tear at the energy.
struct SoftNormal {
  Vector3d direction;
  double length; // that the area vector was divided by
};

SoftNormal softNormal(const Vector3d& area_vector)
{
  constexpr double area_softness = 1e-2; // of twice the area, mean edge lengths^2: 1 % of an equilateral triangle's
  const double length = std::sqrt(area_vector.squaredNorm() + area_softness * area_softness);
  return {area_vector / length, length};
}

using CornerGradients = Eigen::Matrix<double, 9, Eigen::Dynamic>; // of the three corners of each face

struct Work {
  const SurfaceEnergy& energy;
  const MeshGraph& graph;
  const Positions& x;
  Matrix3Xd normals; // soft
  CornerGradients corners;
  bool with_gradient;
};

double fitOfFace(Work& work, Index f)
{
  const OptimizationProblem& problem = work.energy.problem;
  const FacePoints& lists = work.energy.lists;
  const double s2 = work.energy.robust * work.energy.robust;
  double sum = 0.0;
  for (int j = lists.begin[f]; j < lists.begin[f + 1]; ++j) {
    const int i = lists.order[j];
    const double weight = problem.coverage.point_weight[i];
    const Vector3d p = problem.data.points.col(i).cast<double>();
    const Vector3d foot = footOn(work.graph, work.x, f, p);
    Vector3d offset = -p;
    for (int k = 0; k < 3; ++k)
      offset += foot[k] * work.x.col(work.graph.faces(k, f));
    const double squared = offset.squaredNorm(), share = s2 / (s2 + squared);
    sum += weight * squared * share; // Geman, McClure 1987
    // The foot is where the distance is least, so its own motion does not change the distance to first order.
    if (work.with_gradient)
      for (int k = 0; k < 3; ++k)
        work.corners.col(f).segment<3>(3 * k) += 2.0 * weight * share * share * foot[k] * offset;
  }
  return sum;
}

// Gradient of E_smooth at the three sides of face f, by way of its normal; returns half of each side's energy.
double smoothnessOfFace(Work& work, Index f)
{
  double sum = 0.0;
  Vector3d pull = Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const int g = work.graph.across(f, k);
    if (g < 0)
      continue;
    const Vector3d difference = work.normals.col(f) - work.normals.col(g);
    const double t = difference.norm();
    const double length = (work.x.col(work.graph.faces(k, f)) - work.x.col(work.graph.faces((k + 1) % 3, f))).norm();
    sum += 0.5 * length * smoothnessPotential(t);
    pull += length * potentialSlope(t) * difference;
  }
  if (!work.with_gradient)
    return sum;
  Vector3d corner[3];
  for (int k = 0; k < 3; ++k)
    corner[k] = work.x.col(work.graph.faces(k, f));
  const SoftNormal normal = softNormal((corner[1] - corner[0]).cross(corner[2] - corner[0]));
  const Vector3d h = work.energy.kappa1 * (pull - normal.direction * normal.direction.dot(pull)) / normal.length;
  for (int k = 0; k < 3; ++k)
    work.corners.col(f).segment<3>(3 * k) += (corner[(k + 1) % 3] - corner[(k + 2) % 3]).cross(h);
  return sum;
}

// What the lengths of the edges around v add to the gradient of E_smooth.
Vector3d lengthGradient(const Work& work, Index v)
{
  Vector3d sum = Vector3d::Zero();
  for (const int e : edgesAround(work.graph, v)) {
    const auto [f, g] = work.graph.edge_faces[e];
    const Vector3d side = work.x.col(v) - work.x.col(work.graph.otherVertex(e, v));
    const double length = side.norm();
    if (f >= 0 && g >= 0 && length > 0.0)
      sum += smoothnessPotential((work.normals.col(f) - work.normals.col(g)).norm()) / length * side;
  }
  return sum;
}

Vector3d topologyGradient(const Work& work, const Positions& rings, Index v)
{
  Vector3d sum = rings.col(v);
  for (const int e : edgesAround(work.graph, v)) {
    const int other = work.graph.otherVertex(e, v);
    const double count = edgesAround(work.graph, other).size();
    sum -= rings.col(other) / count;
  }
  return 2.0 * sum;
}

Vector3d cornerSum(const Work& work, Index v)
{
  Vector3d sum = Vector3d::Zero();
  for (const int f : facesAround(work.graph, v))
    for (int k = 0; k < 3; ++k)
      if (work.graph.faces(k, f) == v)
        sum += work.corners.col(f).segment<3>(3 * k);
  return sum;
}
} // namespace

double smoothnessPotential(double difference)
{
  return std::sqrt(std::sqrt(difference * difference + potential_scale * potential_scale)) - std::sqrt(potential_scale);
}

Positions oneRings(const MeshGraph& graph, const Positions& x, int threads)
{
  Positions rings = Positions::Zero(3, graph.vertexCount());
  parallelFor(graph.vertexCount(), threads, [&](Index v) {
    if (edgesAround(graph, v).size() > 0)
      rings.col(v) = x.col(v) - meanOfNeighbours(graph, x, v);
  });
  return rings;
}

SurfaceEnergyTerms evaluate(const SurfaceEnergy& energy, const Positions& x, Positions* gradient)
{
  const MeshGraph& graph = energy.problem.graph;
  Work work{energy, graph, x, areaVectors(graph, x, energy.threads), {}, gradient != nullptr};
  parallelFor(graph.faceCount(), energy.threads,
              [&](Index f) { work.normals.col(f) = softNormal(work.normals.col(f)).direction; });
  if (gradient)
    work.corners.setZero(9, graph.faceCount());
  SurfaceEnergyTerms terms;
  terms.fit = parallelSum(graph.faceCount(), energy.threads, 0.0, [&](Index f) { return fitOfFace(work, f); });
  terms.smooth =
      parallelSum(graph.faceCount(), energy.threads, 0.0, [&](Index f) { return smoothnessOfFace(work, f); });
  const Positions rings = oneRings(graph, x, energy.threads) - energy.one_rings;
  terms.topology =
      parallelSum(graph.vertexCount(), energy.threads, 0.0, [&](Index v) { return rings.col(v).squaredNorm(); });
  if (gradient)
    parallelFor(graph.vertexCount(), energy.threads, [&](Index v) {
      gradient->col(v).setZero();
      if (energy.problem.coverage.vertex[v])
        gradient->col(v) = cornerSum(work, v) + energy.kappa1 * lengthGradient(work, v) +
                           energy.kappa2 * topologyGradient(work, rings, v);
    });
  return terms;
}
} // namespace fresco::optimization
