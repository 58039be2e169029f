// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "optimization/common/problem.h"
namespace fresco::optimization {
/// E_fit + kappa_1 E_smooth + kappa_2 E_topology over the vertices that have data.
struct SurfaceEnergy {
  const OptimizationProblem& problem;
  FacePoints lists;    ///< correspondences
  Positions one_rings; ///< 3xV: vertex minus the mean of its neighbours, in the mesh at the start
  double kappa1 = 0, kappa2 = 0;
  double robust = 1; ///< distance at which a datum has lost three quarters of its pull, mean edge lengths
  int threads = 0;
};

struct SurfaceEnergyTerms {
  double fit = 0, smooth = 0, topology = 0;
  double sum(const SurfaceEnergy& energy) const { return fit + energy.kappa1 * smooth + energy.kappa2 * topology; }
};

/// psi(t) = sqrt(sqrt(t^2 + eps^2)) - sqrt(eps): quadratic for t below eps, then a square root (the family of priors of
/// Diebel, Thrun, Bruenig 2006, "A Bayesian method for probable surface reconstruction and decimation").
double smoothnessPotential(double difference);

/// Vertex minus the mean of its neighbours.
Positions oneRings(const MeshGraph& graph, const Positions& x, int threads);

/// @param gradient 3xV of the weighted sum, zero where vertices have no data; nullptr = not wanted
SurfaceEnergyTerms evaluate(const SurfaceEnergy& energy, const Positions& x, Positions* gradient);
} // namespace fresco::optimization
