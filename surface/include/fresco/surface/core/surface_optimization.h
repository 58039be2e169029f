// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <fresco/core/export.h>
#include <fresco/core/mesh.h>
namespace fresco {
/// The algorithm that moves the vertices.
enum class OptimizationMode {
  normal_filtering,                                               ///< filterSurface()
  energy,                                                         ///< minimizeSurfaceEnergy()
  best [[deprecated("use normal_filtering")]] = normal_filtering, ///< old name
  faithful [[deprecated("use energy")]] = energy                  ///< old name
};

/// What both algorithms return. Lengths are in the unit of the mesh.
struct SurfaceOptimizationResult {
  TriangleMesh mesh;      ///< input with moved vertices; normals anew where the input has them, other attributes kept
  Index iterations = 0;   ///< number of accepted steps
  bool converged = false; ///< ended by the convergence test, not by the count
  double edge_length = 0; ///< mean over edges of the input: the unit of the steps
  double spacing = 0;     ///< between the points, median
  Index used_points = 0;  ///< points with a face
  Index left_out_points = 0;   ///< not finite, too far from the mesh, or seen from the wrong side
  Index covered_vertices = 0;  ///< vertices near data; the others stay exactly where they were
  Index restored_vertices = 0; ///< vertices put back by the final check
};

/// Bytes that an optimisation of so many faces by so many points takes, mesh and points included, to about a tenth. The
/// whole mesh is optimised at once: one that takes more than machineMemory() is refused.
FRESCO_EXPORT std::size_t optimizationMemory(Index faces, Index points);
} // namespace fresco
