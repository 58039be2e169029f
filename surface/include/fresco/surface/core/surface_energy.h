// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/point_set.h>
#include <fresco/core/progress.h>
#include <fresco/surface/core/surface_optimization.h>
#include <vector>
namespace fresco {
/// E_fit + kappa_1 E_smooth + kappa_2 E_topology of Pitzer's thesis "Automatic Reconstruction of Textured 3D Models",
/// eq. 4.10, minimised by non-linear conjugate gradients (Shewchuk 1994). The smoothness prior is of the family of
/// Diebel, Thrun, Bruenig 2006, "A Bayesian method for probable surface reconstruction and decimation".
/// Weights are for lengths in mean edge lengths, so that they mean the same for every model.
struct EnergyOptions {
  int iterations = 200;    ///< at most, 1..10000; correspondences are found anew in each
  double kappa1 = 0.1;     ///< weight of E_smooth, >= 0
  double kappa2 = 0.1;     ///< weight of E_topology at the start, >= 0; it is halved down to 1/64
  double tolerance = 1e-4; ///< ends when a step moves the vertices by less; RMS, mean edge lengths, >= 0
  int threads = 0;         ///< 0 = all cores; the result does not depend on it
};

/// An accepted step; terms after it, without kappa_1 and kappa_2; mean edge length as unit.
struct EnergyStep {
  double fit = 0;      ///< E_fit: robust squared distances of the data times the area that each stands for
  double smooth = 0;   ///< E_smooth: edge length times potential of the difference of its two normals
  double topology = 0; ///< E_topology: squared differences of the one-rings from those at the start
  double kappa2 = 0;   ///< weight of E_topology in this step
  double before = 0;   ///< weighted sum ahead of the step, with its correspondences and weights
  double after = 0;    ///< weighted sum after it; never above `before`
  double move = 0;     ///< RMS move of the vertices
};

struct EnergyResult : SurfaceOptimizationResult {
  std::vector<EnergyStep> steps;
};

/// Moves the vertices to a local minimum of the energy; the connectivity stays.
/// @param mesh, points as for filterSurface()
/// @throws std::invalid_argument, Cancelled as filterSurface()
FRESCO_EXPORT EnergyResult minimizeSurfaceEnergy(const TriangleMesh& mesh, const PointSet& points,
                                                 const EnergyOptions& options = {}, const Progress& progress = {});
} // namespace fresco
