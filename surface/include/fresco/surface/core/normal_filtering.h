// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <fresco/core/export.h>
#include <fresco/core/mesh.h>
#include <fresco/core/point_set.h>
#include <fresco/core/progress.h>
#include <vector>
namespace fresco {
/// Two-stage mesh denoising with data: filtered face normals, then a vertex update, alternately.
/// Sun, Rosin, Martin, Langbein 2007, "Fast and effective feature-preserving mesh denoising";
/// Zheng, Fu, Au, Tai 2011, "Bilateral normal filtering for mesh denoising".
/// Weights are for lengths in mean edge lengths, so that they mean the same for every model.
struct NormalFilteringOptions {
  int iterations = 8;             ///< at most, 1..8
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

/// Lengths are in the unit of the mesh.
struct NormalFilteringResult {
  TriangleMesh mesh;      ///< input with moved vertices; normals anew where the input has them, other attributes kept
  Index iterations = 0;   ///< number of accepted steps
  bool converged = false; ///< ended by the convergence test, not by the count
  double edge_length = 0; ///< mean over edges of the input: the unit of the steps
  double spacing = 0;     ///< between the points, median
  Index used_points = 0;  ///< points with a face
  Index left_out_points = 0;   ///< not finite, too far from the mesh, or seen from the wrong side
  Index turned_faces = 0;      ///< faces of patches that more points looked against than with; theirs are turned
  Index covered_vertices = 0;  ///< vertices near data; the others stay exactly where they were
  Index restored_vertices = 0; ///< vertices put back by the final check
  std::vector<NormalFilteringStep> steps;
  double noise = 0; ///< deviation of the points from the surface, estimated from the points
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

/// Bytes that an optimisation of so many faces by so many points takes, mesh and points included, to about a tenth. The
/// whole mesh is optimised at once: one that takes more than machineMemory() is refused.
FRESCO_EXPORT std::size_t optimizationMemory(Index faces, Index points);
} // namespace fresco
