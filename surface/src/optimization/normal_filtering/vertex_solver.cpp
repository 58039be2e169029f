// SPDX-License-Identifier: BSD-3-Clause
#include "optimization/normal_filtering/vertex_solver.h"
#include <Eigen/LU>
#include <fresco/core/parallel.h>
namespace fresco::optimization {
namespace {
using Eigen::Matrix3d;
using Eigen::Vector3d;

struct System {
  const QuadraticEnergy& energy;
  const MeshGraph& graph;
  int threads;
  Index size() const { return graph.vertexCount(); }
};

int cornerOf(const MeshGraph& graph, int f, Index v)
{
  return graph.faces(0, f) == v ? 0 : graph.faces(1, f) == v ? 1 : 2;
}

Vector3d heights(const FaceTerm& term, const MeshGraph& graph, Index f, const Positions& d)
{
  const Vector3d n = term.normal.cast<double>();
  return {n.dot(d.col(graph.faces(0, f))), n.dot(d.col(graph.faces(1, f))), n.dot(d.col(graph.faces(2, f)))};
}

// Symmetric 3x3 matrix of the term in the heights of its corners, times u.
Vector3d times(const FaceTerm& t, const Vector3d& u)
{
  const double s = t.smoothness, p01 = t.off_diagonal[0] - s, p12 = t.off_diagonal[1] - s, p20 = t.off_diagonal[2] - s;
  return {(t.diagonal[0] + 2 * s) * u[0] + p01 * u[1] + p20 * u[2],
          p01 * u[0] + (t.diagonal[1] + 2 * s) * u[1] + p12 * u[2],
          p20 * u[0] + p12 * u[1] + (t.diagonal[2] + 2 * s) * u[2]};
}

// Sum over the faces around each free vertex of its corner's share, along the face's normal, and own(v) of the vertex.
template <typename Own>
void gather(const System& system, const Eigen::Matrix3Xd& shares, const Own& own, Positions& result)
{
  parallelFor(system.size(), system.threads, [&](Index v) {
    if (!system.energy.free[v]) {
      result.col(v).setZero();
      return;
    }
    Vector3d sum = own(v);
    for (const int f : facesAround(system.graph, v))
      sum += shares(cornerOf(system.graph, f, v), f) * system.energy.faces[f].normal.cast<double>();
    result.col(v) = sum;
  });
}

void multiply(const System& system, const Positions& d, Eigen::Matrix3Xd& shares, Positions& result)
{
  parallelFor(system.graph.faceCount(), system.threads, [&](Index f) {
    const FaceTerm& term = system.energy.faces[f];
    shares.col(f) = times(term, heights(term, system.graph, f, d));
  });
  const auto own = [&](Index v) -> Vector3d { return system.energy.vertices[v].tangential.cast<double>() * d.col(v); };
  gather(system, shares, own, result);
}

Positions rightHandSide(const System& system, const Positions& x)
{
  Eigen::Matrix3Xd shares(3, system.graph.faceCount());
  parallelFor(system.graph.faceCount(), system.threads, [&](Index f) {
    const FaceTerm& t = system.energy.faces[f];
    const Vector3d u = heights(t, system.graph, f, x);
    const double sum = u.sum();
    for (int k = 0; k < 3; ++k)
      shares(k, f) = t.linear[k] + t.smoothness * (sum - 3 * u[k]);
  });
  Positions b(3, system.size());
  const auto own = [&](Index v) -> Vector3d {
    const VertexTerm& term = system.energy.vertices[v];
    return (term.tangential * term.target).cast<double>();
  };
  gather(system, shares, own, b);
  return b;
}

std::vector<Matrix3d> inverseBlocks(const System& system)
{
  std::vector<Matrix3d> inverse(system.size(), Matrix3d::Zero());
  parallelFor(system.size(), system.threads, [&](Index v) {
    if (!system.energy.free[v])
      return;
    Matrix3d block = system.energy.vertices[v].tangential.cast<double>();
    for (const int f : facesAround(system.graph, v)) {
      const FaceTerm& t = system.energy.faces[f];
      const Vector3d n = t.normal.cast<double>();
      block += (t.diagonal[cornerOf(system.graph, f, v)] + 2.0 * t.smoothness) * n * n.transpose();
    }
    block.diagonal().array() += 1e-9 * block.trace() + 1e-30;
    inverse[v] = block.inverse();
  });
  return inverse;
}

double dot(const Positions& a, const Positions& b, int threads)
{
  return parallelSum(a.cols(), threads, 0.0, [&](Index v) { return a.col(v).dot(b.col(v)); });
}

void precondition(const System& system, const std::vector<Matrix3d>& inverse, const Positions& r, Positions& z)
{
  parallelFor(system.size(), system.threads, [&](Index v) { z.col(v) = inverse[v] * r.col(v); });
}
} // namespace

QuadraticTerms evaluate(const QuadraticEnergy& energy, const MeshGraph& graph, const Positions& x,
                        const Positions& move, int threads)
{
  const auto add = [](QuadraticTerms a, const QuadraticTerms& b) {
    return QuadraticTerms{a.fit + b.fit, a.smoothness + b.smoothness, a.tangential + b.tangential};
  };
  const auto faces = [&](Index begin, Index end) {
    QuadraticTerms sum;
    for (Index f = begin; f < end; ++f) {
      const FaceTerm& t = energy.faces[f];
      const Vector3d d = heights(t, graph, f, move), u = heights(t, graph, f, x) + d;
      const Vector3d pull(t.linear[0], t.linear[1], t.linear[2]), own(t.diagonal[0], t.diagonal[1], t.diagonal[2]);
      const double pairs =
          t.off_diagonal[0] * d[0] * d[1] + t.off_diagonal[1] * d[1] * d[2] + t.off_diagonal[2] * d[2] * d[0];
      sum.fit += t.constant - 2 * pull.dot(d) + own.dot(d.cwiseAbs2()) + 2 * pairs;
      sum.smoothness += t.smoothness *
                        ((u[0] - u[1]) * (u[0] - u[1]) + (u[1] - u[2]) * (u[1] - u[2]) + (u[2] - u[0]) * (u[2] - u[0]));
    }
    return sum;
  };
  const auto vertices = [&](Index begin, Index end) {
    QuadraticTerms sum;
    for (Index v = begin; v < end; ++v) {
      const Vector3d off = move.col(v) - energy.vertices[v].target.cast<double>();
      if (energy.free[v])
        sum.tangential += off.dot(energy.vertices[v].tangential.cast<double>() * off);
    }
    return sum;
  };
  return add(parallelReduce(graph.faceCount(), threads, QuadraticTerms{}, faces, add),
             parallelReduce(graph.vertexCount(), threads, QuadraticTerms{}, vertices, add));
}

Positions solveMoves(const QuadraticEnergy& energy, const MeshGraph& graph, const Positions& x, int rounds, int threads)
{
  const System system{energy, graph, threads};
  const std::vector<Matrix3d> inverse = inverseBlocks(system);
  Positions residual = rightHandSide(system, x);
  Positions move = Positions::Zero(3, system.size()), z(3, system.size()), product(3, system.size());
  Eigen::Matrix3Xd shares(3, graph.faceCount());
  precondition(system, inverse, residual, z);
  Positions direction = z;
  double rho = dot(residual, z, threads);
  const double enough = 1e-4 * rho; // a hundredth of the first residual: the next iteration has another energy
  double part = 1.0;                // of a round that counts, so that no round comes or goes at once
  for (int round = 0; round < rounds; ++round) {
    part = std::min(part, ramp(rho, enough, 2.0 * enough));
    if (!(part > 0.0))
      break;
    multiply(system, direction, shares, product);
    const double curvature = dot(direction, product, threads);
    if (!(curvature > 0.0))
      break;
    const double step = rho / curvature;
    parallelFor(system.size(), threads, [&](Index v) {
      move.col(v) += part * step * direction.col(v);
      residual.col(v) -= step * product.col(v);
    });
    precondition(system, inverse, residual, z);
    const double last = rho;
    rho = dot(residual, z, threads);
    parallelFor(system.size(), threads, [&](Index v) { direction.col(v) = z.col(v) + rho / last * direction.col(v); });
  }
  return move;
}
} // namespace fresco::optimization
