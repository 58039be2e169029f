// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/point_set.h>
#include <fresco/core/progress.h>
#include <fresco/surface/core/surface_optimization.h>
#include <vector>
namespace fresco {
/// Two-stage mesh denoising with data: filtered face normals, then a vertex update, alternately.
/// Sun, Rosin, Martin, Langbein 2007, "Fast and effective feature-preserving mesh denoising";
/// Zheng, Fu, Au, Tai 2011, "Bilateral normal filtering for mesh denoising".
/// Weights are for lengths in mean edge lengths, so that they mean the same for every model.
struct NormalFilteringOptions {
  int iterations = 15;            ///< at most, 1..10000; eight are enough, more are not done
  double smoothness_weight = 1;   ///< of the edges' slopes against the filtered normals, >= 0
  double tangential_weight = 0.1; ///< of sliding towards well-shaped triangles, >= 0
  bool flip = false;              ///< edges are flipped so that they follow the creases
  double tolerance = 1e-3;        ///< ends when a step moves the vertices by less; RMS, mean edge lengths, >= 0
  int threads = 0;                ///< 0 = all cores; the result does not depend on it
};

/// A step: terms of its quadratic energy after it, weights included; mean edge length as unit. Of late steps only a part
/// is done; the terms are those of the whole.
struct NormalFilteringStep {
  double fit = 0;        ///< robust squared point-to-plane distances times the area that each datum stands for
  double smoothness = 0; ///< squared slopes of the edges against the filtered normals
  double tangential = 0; ///< squared differences from the places that vertices slide to
  double before = 0;     ///< sum of the terms ahead of the step
  double after = 0;      ///< sum of the terms after it; never above `before`
  double move = 0;       ///< RMS move of the vertices
};

struct NormalFilteringResult : SurfaceOptimizationResult {
  std::vector<NormalFilteringStep> steps;
  double noise = 0; ///< deviation of the points from the surface, estimated from the points; unit of the mesh
  Index flipped_edges = 0;
};

/// Moves the vertices so that the mesh fits the points it was made of and is sharp where they are. The connectivity
/// stays unless `flip`.
/// @param mesh   any triangle mesh; degenerate faces are kept and ignored; non-manifold edges are kept and not
///               smoothed across. Vertices that no face names may be anything.
/// @param points in the world frame of the mesh; origins may differ. Normals are optional and help where two surfaces
///               are close together. Non-finite points are left out.
/// @throws std::invalid_argument if the mesh is not valid or has no area, there is no finite point, no point is near
///         the mesh, or an option is out of range
/// @throws std::runtime_error if optimizationMemory() exceeds what the machine has
/// @throws Cancelled if `progress` asks to stop
FRESCO_EXPORT NormalFilteringResult filterSurface(const TriangleMesh& mesh, const PointSet& points,
                                                  const NormalFilteringOptions& options = {},
                                                  const Progress& progress = {});
} // namespace fresco
