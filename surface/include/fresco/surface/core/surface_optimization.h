// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/mesh.h>
#include <fresco/core/point_set.h>
#include <fresco/core/progress.h>
#include <vector>
namespace fresco {
enum class OptimizationMode {
  best,    ///< filtered face normals and point-to-plane fit, solved alternately
  faithful ///< non-linear conjugate gradients on E_fit + kappa_1 E_smooth + kappa_2 E_topology
};

/// Moves the vertices of a mesh so that it fits the points it was made of and is sharp where they are; the connectivity
/// stays unless `flip`. Energies are measured with the mean edge length as unit, so that weights mean the same for
/// every model.
struct SurfaceOptimizationOptions {
  OptimizationMode mode = OptimizationMode::best;
  int iterations = 0; ///< at most, 0..10000, correspondences are found anew in each; 0 = 15 (best), 200 (faithful)
  double kappa1 = -1; ///< weight of E_smooth, >= 0; negative = 1 (best), 0.1 (faithful)
  double kappa2 = -1; ///< weight of E_topology at the start, >= 0; negative = 0.1
  bool flip = false;  ///< edges are flipped so that they follow the creases
  double tolerance =
      1e-3;        ///< ends when a step moves the vertices by less (RMS, mean edge lengths; faithful: a tenth), >= 0
  int threads = 0; ///< 0 = all cores; the result does not depend on it
};

/// The state after an accepted step; sums, with the mean edge length as unit. In best mode the terms are those of the
/// quadratic energy of the step, weights included; in faithful mode they are without kappa_1 and kappa_2.
struct OptimizationStep {
  double fit = 0;    ///< E_fit: robust squared distances of the data, times the area that each stands for
  double smooth = 0; ///< E_smooth: faithful: edge length times potential of the normal difference; best: squared slopes
  double topology =
      0; ///< E_topology: squared differences of the one-rings from those at the start; best: from relaxed ones
  double kappa2 = 0; ///< weight of E_topology in this step
  double before = 0; ///< weighted sum ahead of the step, with the correspondences and weights of this step
  double after = 0;  ///< the same sum after it; never above `before`
  double move = 0;   ///< RMS move of the vertices, mean edge lengths
};

/// Lengths are in the unit of the mesh unless said otherwise.
struct SurfaceOptimizationResult {
  TriangleMesh
      mesh; ///< input with moved vertices; normals anew where the input has them; other attributes as they were
  std::vector<OptimizationStep> steps;
  bool converged = false;       ///< ended by the convergence test, not by the count
  double edge_length = 0;       ///< mean over edges of the input: the unit of the steps
  double noise = 0;             ///< deviation of the points from the surface, estimated from the points
  double spacing = 0;           ///< between the points, median
  Index used_points = 0;        ///< points with a face
  Index left_out_points = 0;    ///< not finite, too far from the mesh, or seen from the wrong side
  Index supported_vertices = 0; ///< vertices near data; the others stay exactly where they were
  Index restored_vertices = 0;  ///< vertices put back by the final check
  Index flipped_edges = 0;
};

/// @param mesh   any triangle mesh; degenerate faces are kept and ignored, non-manifold edges are kept and not smoothed
///               across. Vertices that no face names may be anything.
/// @param points in the world frame of the mesh; origins may differ. Normals are optional and help where two surfaces
/// are
///               close together. Non-finite points are left out.
/// @throws std::invalid_argument if the mesh is not valid or has no area, there is no finite point, no point is near
/// the
///         mesh, or an option is out of range
/// @throws Cancelled if `progress` asks to stop
FRESCO_EXPORT SurfaceOptimizationResult optimizeSurface(const TriangleMesh& mesh, const PointSet& points,
                                                        const SurfaceOptimizationOptions& options = {},
                                                        const Progress& progress = {});
} // namespace fresco
