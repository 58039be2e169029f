// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/SparseCholesky>
#include <cmath>
#include <fresco/registration/core/pose_graph.h>
namespace fresco::registration {
namespace {
Eigen::Isometry3d motion(const Vector6d& step, double size)
{
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = rotation(step.head<3>() / size);
  T.translation() = step.tail<3>();
  return T;
}

class PoseGraph {
public:
  PoseGraph(const PoseEdges& edges, const PoseGraphOptions& options) : edges_(edges), options_(options) {}
  IsometryVector run(IsometryVector poses) const;

private:
  bool fixed(Index i) const { return options_.fixed.empty() ? i == 0 : options_.fixed[i] != 0; }
  Vector6d error(const IsometryVector& poses, const PoseEdge& edge) const;
  double energy(const IsometryVector& poses) const;
  Eigen::VectorXd step(const IsometryVector& poses, double damping) const;
  IsometryVector moved(const IsometryVector& poses, const Eigen::VectorXd& x) const;

  const PoseEdges& edges_;
  const PoseGraphOptions& options_;
};

// Rotation (times size) and translation that the edge misses, in the frame of b.
Vector6d PoseGraph::error(const IsometryVector& poses, const PoseEdge& edge) const
{
  const Eigen::Isometry3d difference = edge.T_a_b.inverse() * poses[edge.a].inverse() * poses[edge.b];
  const Eigen::AngleAxisd turn(difference.linear());
  Vector6d e;
  e << options_.size * turn.angle() * turn.axis(), difference.translation();
  return e;
}

double PoseGraph::energy(const IsometryVector& poses) const
{
  const double c = options_.tolerance * options_.tolerance;
  double sum = 0.0;
  for (const PoseEdge& edge : edges_) {
    const Vector6d e = error(poses, edge);
    const double squared = e.dot(edge.information * e);
    sum += edge.weight * c * squared / (c + squared);
  }
  return sum;
}

Eigen::VectorXd PoseGraph::step(const IsometryVector& poses, double damping) const
{
  const Index n = 6 * poses.size();
  const double c = options_.tolerance * options_.tolerance;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd g = Eigen::VectorXd::Zero(n), diagonal = Eigen::VectorXd::Zero(n);
  const auto add = [&](Index row, Index column, const Matrix6d& block) {
    for (Index r = 0; r < 6; ++r)
      for (Index k = 0; k < 6; ++k)
        entries.emplace_back(6 * row + r, 6 * column + k, block(r, k));
  };
  for (const PoseEdge& edge : edges_) {
    const Vector6d e = error(poses, edge), We = edge.information * e;
    const double falloff = c / (c + e.dot(We)), weight = edge.weight * falloff * falloff;
    const Eigen::Isometry3d T = poses[edge.b].inverse() * poses[edge.a];
    // The error moves with b and against a motion of a carried over to the frame of b.
    Matrix6d J = Matrix6d::Zero();
    J.topLeftCorner<3, 3>() = J.bottomRightCorner<3, 3>() = -T.linear();
    J.bottomLeftCorner<3, 3>() = -skew(T.translation()) * T.linear() / options_.size;
    const Matrix6d WJ = edge.information * J, JtWJ = J.transpose() * WJ;
    add(edge.a, edge.a, weight * JtWJ);
    add(edge.a, edge.b, weight * WJ.transpose());
    add(edge.b, edge.a, weight * WJ);
    add(edge.b, edge.b, weight * edge.information);
    g.segment<6>(6 * edge.a) += weight * J.transpose() * We;
    g.segment<6>(6 * edge.b) += weight * We;
    diagonal.segment<6>(6 * edge.a) += weight * JtWJ.diagonal();
    diagonal.segment<6>(6 * edge.b) += weight * edge.information.diagonal();
  }
  for (Index k = 0; k < n; ++k)
    entries.emplace_back(k, k, damping * diagonal[k] + 1e-12);
  Eigen::SparseMatrix<double> H(n, n);
  H.setFromTriplets(entries.begin(), entries.end());
  // Rows of fixed poses become those of the identity.
  H.prune([&](Index row, Index column, double) { return !fixed(row / 6) && !fixed(column / 6); });
  for (Index k = 0; k < n; ++k)
    if (fixed(k / 6)) {
      H.coeffRef(k, k) = 1.0;
      g[k] = 0.0;
    }
  return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(H).solve(-g);
}

IsometryVector PoseGraph::moved(const IsometryVector& poses, const Eigen::VectorXd& x) const
{
  IsometryVector result = poses;
  const Index n = poses.size();
  for (Index i = 0; i < n; ++i)
    if (!fixed(i)) {
      result[i] = poses[i] * motion(x.segment<6>(6 * i), options_.size);
      result[i].linear() = normalized(result[i].linear());
    }
  return result;
}

IsometryVector PoseGraph::run(IsometryVector poses) const
{
  constexpr double least_gain = 1e-9;  // relative fall of the energy: less is rounding
  constexpr double most_damping = 1e8; // steps are then a hundred millionth of what they were
  double damping = 1e-6, now = energy(poses);
  for (int k = 0; k < options_.max_iterations && damping < most_damping; ++k) {
    const Eigen::VectorXd x = step(poses, damping);
    const IsometryVector next = moved(poses, x);
    const double then = energy(next);
    if (!(then < now)) {
      damping *= 10.0;
      continue;
    }
    const bool done = now - then < least_gain * now;
    poses = next;
    now = then;
    damping = std::max(1e-9, 0.1 * damping);
    if (done)
      break;
  }
  return poses;
}
} // namespace

IsometryVector optimizePoseGraph(IsometryVector poses, const PoseEdges& edges, const PoseGraphOptions& options)
{
  return edges.empty() ? poses : PoseGraph(edges, options).run(std::move(poses));
}
} // namespace fresco::registration
