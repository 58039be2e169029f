// SPDX-License-Identifier: BSD-3-Clause
#include "stages/fusion.h"
#include "stages/placed_points.h"
#include "stages/stages.h"
#include <fresco/io/mesh_io.h>
#include <fresco/surface/core/normal_filtering.h>
namespace fresco::model {
Figures makeOptimizedSurface(const Job& job, const Progress& progress)
{
  const auto& [input, files, options, stages, ranks] = job;
  report(progress, "read", 0.0);
  const TriangleMesh surface = readMesh(files.surface);
  // Fused depth images gain less than a per cent by it, for half of the time that the surface takes:
  // docs/measurements/depth_fusion.md.
  if (!options.optimize || input.rgbd) {
    writeMesh(files.mesh, surface);
    return {{"optimized", false}};
  }
  const PointSet points =
      pointsForVertices(*PlacedPoints(files.points).stream(), surface.vertexCount(), finestCell(job));
  const NormalFilteringResult result = filterSurface(surface, points, stages.optimization, progress);
  writeMesh(files.mesh, result.mesh);
  return {{"optimized", true},
          {"iterations", result.iterations},
          {"converged", result.converged},
          {"points", points.size()},
          {"noise", result.noise},
          {"covered_vertices", result.covered_vertices},
          {"restored_vertices", result.restored_vertices},
          {"flipped_edges", result.flipped_edges}};
}
} // namespace fresco::model
