// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "optimization/common/data_coverage.h"
namespace fresco::optimization {
/// Quadratic energy of the best mode around the present positions x, in the moves d of the vertices:
///   sum_i w_i (n_f . (x(foot_i) + d(foot_i) - p_i))^2 + sum_f s_f sum_{edges (a,b) of f} (n_f . (x_a + d_a - x_b -
///   d_b))^2
///   + sum_v |T_v (d_v - r_v)|^2
/// n_f: target normal of the face; w_i: area that the datum stands for times its robust weight; s_f: slope weight;
/// T_v, r_v: the directions in which the vertex may slide along the surface, and where it slides to.
struct FaceTerm {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  float pair[3] = {0, 0, 0}; ///< sum w b_j b_k of the corners (0,1), (1,2), (2,0)
  float own[3] = {0, 0, 0};  ///< sum w b_k^2
  float pull[3] = {0, 0, 0}; ///< sum w b_k n . (p - x(foot))
  float slope = 0;           ///< s_f
  float constant = 0;        ///< sum w (n . (p - x(foot)))^2
};

struct VertexTerm {
  Eigen::Matrix3f slide = Eigen::Matrix3f::Zero();  ///< T_v^T T_v
  Eigen::Vector3f target = Eigen::Vector3f::Zero(); ///< r_v
};

struct QuadraticEnergy {
  std::vector<FaceTerm> faces;
  std::vector<VertexTerm> vertices;
  std::vector<char> free; ///< V, 0: the vertex does not move
};

struct EnergyTerms {
  double fit = 0, slope = 0, slide = 0;
  double sum() const { return fit + slope + slide; }
};

EnergyTerms evaluate(const QuadraticEnergy& energy, const MeshGraph& graph, const Positions& x, const Positions& move,
                     int threads);

/// The moves that minimise the energy, by conjugate gradients preconditioned with the blocks of the vertices. Stopped
/// early they still lower it.
Positions solveMoves(const QuadraticEnergy& energy, const MeshGraph& graph, const Positions& x, int rounds,
                     int threads);
} // namespace fresco::optimization
