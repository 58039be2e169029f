// SPDX-License-Identifier: BSD-3-Clause
#include "model/optimization_stage.h"
#include <fresco/common/mesh_io.h>
#include <fresco/common/point_io.h>
#include <fresco/surface/core/surface_optimization.h>
namespace fresco {
nlohmann::ordered_json makeOptimizedSurface(const ModelFiles& files, const ModelOptions& options,
                                            const Progress& progress)
{
  report(progress, "read", 0.0);
  const TriangleMesh surface = readMesh(files.surface);
  if (!options.optimize) {
    writeMesh(files.mesh, surface);
    return {{"optimized", false}};
  }
  SurfaceOptimizationOptions optimization;
  optimization.flip = true;
  optimization.threads = options.threads;
  const SurfaceOptimizationResult result = optimizeSurface(surface, readPoints(files.points), optimization, progress);
  writeMesh(files.mesh, result.mesh);
  return {{"optimized", true},
          {"iterations", result.steps.size()},
          {"converged", result.converged},
          {"noise", result.noise},
          {"supported_vertices", result.supported_vertices},
          {"restored_vertices", result.restored_vertices},
          {"flipped_edges", result.flipped_edges}};
}
} // namespace fresco
