// SPDX-License-Identifier: BSD-3-Clause
#include "optimization/normal_filtering/vertex_solver.h"
#include <Eigen/LU>
#include <fresco/core/parallel.h>
namespace fresco::optimization {
namespace {
using Eigen::Matrix3d;
using Eigen::Vector3d;

int cornerOf(const MeshGraph& graph, int f, Index v)
{
  return graph.faces(0, f) == v ? 0 : graph.faces(1, f) == v ? 1 : 2;
}

// The faces around a vertex side by side: entry j is face graph.vertex_faces[j].
struct System {
  System(const QuadraticEnergy& given, const MeshGraph& of, int use)
      : energy(given), graph(of), threads(use), entry(3, of.faceCount()), normals(3, of.vertex_faces.size())
  {
    entry.setConstant(-1); // of degenerate faces
    parallelFor(size(), threads, [&](Index v) {
      for (int j = graph.face_begin[v]; j < graph.face_begin[v + 1]; ++j) {
        const int f = graph.vertex_faces[j];
        entry(cornerOf(graph, f, v), f) = j;
        normals.col(j) = energy.faces[f].normal;
      }
    });
  }

  Index size() const { return graph.vertexCount(); }

  const QuadraticEnergy& energy;
  const MeshGraph& graph;
  int threads;
  Faces entry;              // 3xF, of each corner
  Eigen::Matrix3Xf normals; // by entry
};

inline Vector3d heights(const FaceTerm& term, const MeshGraph& graph, Index f, const Positions& d)
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

using Shares = Eigen::VectorXd; // along the normals of the faces, by entry

// Sets the shares of the corners of each face to what `of` says.
template <typename Of>
void setShares(const System& system, const Of& of, Shares& shares)
{
  parallelFor(system.graph.faceCount(), system.threads, [&](Index f) {
    const Vector3d corners = of(f);
    for (int k = 0; k < 3; ++k)
      if (const int j = system.entry(k, f); j >= 0)
        shares[j] = corners[k];
  });
}

// Sum of the shares around v.
Vector3d gathered(const System& system, const Shares& shares, Index v)
{
  Vector3d sum = Vector3d::Zero();
  for (int j = system.graph.face_begin[v]; j < system.graph.face_begin[v + 1]; ++j)
    sum += shares[j] * system.normals.col(j).cast<double>();
  return sum;
}

// The matrix times d, zero for vertices that are not free. @returns d . result
double multiply(const System& system, const Positions& d, Shares& shares, Positions& result)
{
  const auto product = [&](Index f) {
    const FaceTerm& term = system.energy.faces[f];
    return times(term, heights(term, system.graph, f, d));
  };
  setShares(system, product, shares);
  return parallelSum(system.size(), system.threads, 0.0, [&](Index v) {
    if (system.energy.free[v])
      result.col(v) = system.energy.vertices[v].tangential.cast<double>() * d.col(v) + gathered(system, shares, v);
    else
      result.col(v).setZero();
    return d.col(v).dot(result.col(v));
  });
}

Positions rightHandSide(const System& system, const Positions& x, Shares& shares)
{
  const auto pull = [&](Index f) -> Vector3d {
    const FaceTerm& t = system.energy.faces[f];
    const Vector3d u = heights(t, system.graph, f, x);
    return Vector3d(t.linear[0], t.linear[1], t.linear[2]) + t.smoothness * (Vector3d::Constant(u.sum()) - 3 * u);
  };
  setShares(system, pull, shares);
  Positions b = Positions::Zero(3, system.size());
  parallelFor(system.size(), system.threads, [&](Index v) {
    const VertexTerm& term = system.energy.vertices[v];
    if (system.energy.free[v])
      b.col(v) = (term.tangential * term.target).cast<double>() + gathered(system, shares, v);
  });
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
  const System system(energy, graph, threads);
  const std::vector<Matrix3d> inverse = inverseBlocks(system);
  Shares shares = Shares::Zero(graph.vertex_faces.size());
  Positions residual = rightHandSide(system, x, shares);
  Positions move = Positions::Zero(3, system.size()), direction(3, system.size()), product(3, system.size());
  Positions& preconditioned = product; // residual, once the product has served
  double rho = parallelSum(system.size(), threads, 0.0, [&](Index v) {
    direction.col(v) = inverse[v] * residual.col(v);
    return residual.col(v).dot(direction.col(v));
  });
  const double enough = 1e-4 * rho; // a hundredth of the first residual: the next iteration has another energy
  double part = 1.0;                // of a round that counts, so that no round comes or goes at once
  for (int round = 0; round < rounds; ++round) {
    part = std::min(part, ramp(rho, enough, 2.0 * enough));
    if (!(part > 0.0))
      break;
    const double curvature = multiply(system, direction, shares, product);
    if (!(curvature > 0.0))
      break;
    const double step = rho / curvature, last = rho;
    rho = parallelSum(system.size(), threads, 0.0, [&](Index v) {
      move.col(v) += part * step * direction.col(v);
      residual.col(v) -= step * product.col(v);
      preconditioned.col(v) = inverse[v] * residual.col(v);
      return residual.col(v).dot(preconditioned.col(v));
    });
    parallelFor(system.size(), threads,
                [&](Index v) { direction.col(v) = preconditioned.col(v) + rho / last * direction.col(v); });
  }
  return move;
}
} // namespace fresco::optimization
