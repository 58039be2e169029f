// SPDX-License-Identifier: BSD-3-Clause
#include "stages/optimization.h"
#include "stages/fusion.h"
#include "stages/stages.h"
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <fresco/surface/core/normal_filtering.h>
namespace fresco::model {
PointSet pointsForVertices(PointSet points, Index vertices, double cell)
{
  constexpr Index most_per_vertex = 16; // more cost memory and time in every iteration and say little that is new
  if (points.size() <= most_per_vertex * vertices || !points.hasNormals())
    return points;
  points.viewpoints.resize(3, 0);
  points.colors.resize(3, 0);
  PointFusion fusion(cell / 3);
  fusion.add(points);
  const Eigen::Vector3d origin = points.origin;
  points = PointSet();
  points = fusion.result();
  points.origin = origin;
  return points;
}

Figures makeOptimizedSurface(const Job& job, const Progress& progress)
{
  const auto& [input, files, options] = job;
  report(progress, "read", 0.0);
  const TriangleMesh surface = readMesh(files.surface);
  if (!options.optimize) {
    writeMesh(files.mesh, surface);
    return {{"optimized", false}};
  }
  NormalFilteringOptions filtering;
  filtering.flip = true;
  filtering.threads = options.threads;
  const PointSet points = pointsForVertices(readPoints(files.points), surface.vertexCount(), finestCell(job));
  const NormalFilteringResult result = filterSurface(surface, points, filtering, progress);
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
