// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "optimization/common/data_coverage.h"
namespace fresco::optimization {
/// Quadratic energy of the vertex update around the present positions x, in the moves d of the vertices:
///     sum_i w_i (n_f . (x(foot_i) + d(foot_i) - p_i))^2                               fit
///   + sum_f s_f sum_{edges (a, b) of f} (n_f . (x_a + d_a - x_b - d_b))^2            smoothness (Sun et al. 2007)
///   + sum_v |T_v (d_v - r_v)|^2                                                     tangential
/// n_f: filtered normal of the face; w_i: area that the datum stands for times its robust weight; s_f: smoothness
/// weight; T_v, r_v: the directions in which the vertex may slide along the surface, and where it slides to.
struct FaceTerm {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  float off_diagonal[3] = {0, 0, 0}; ///< sum w b_j b_k of the corners (0,1), (1,2), (2,0)
  float diagonal[3] = {0, 0, 0};     ///< sum w b_k^2
  float linear[3] = {0, 0, 0};       ///< sum w b_k n . (p - x(foot))
  float smoothness = 0;              ///< s_f
  float constant = 0;                ///< sum w (n . (p - x(foot)))^2
};

struct VertexTerm {
  Eigen::Matrix3f tangential = Eigen::Matrix3f::Zero(); ///< T_v^T T_v
  Eigen::Vector3f target = Eigen::Vector3f::Zero();     ///< r_v
};

struct QuadraticEnergy {
  std::vector<FaceTerm> faces;
  std::vector<VertexTerm> vertices;
  std::vector<char> free; ///< V, 0: the vertex does not move
};

struct QuadraticTerms {
  double fit = 0, smoothness = 0, tangential = 0;
  double sum() const { return fit + smoothness + tangential; }
};

QuadraticTerms evaluate(const QuadraticEnergy& energy, const MeshGraph& graph, const Positions& x,
                        const Positions& move, int threads);

/// The moves that minimise the energy, by conjugate gradients preconditioned with the blocks of the vertices. Stopped
/// early they still lower it.
Positions solveMoves(const QuadraticEnergy& energy, const MeshGraph& graph, const Positions& x, int rounds,
                     int threads);
} // namespace fresco::optimization
