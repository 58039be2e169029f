// SPDX-License-Identifier: BSD-3-Clause
#include "model/surface_stage.h"
#include <fresco/common/mesh_io.h>
#include <fresco/common/point_io.h>
#include <fresco/common/require.h>
#include <fresco/surface/core/volumetric_reconstruction.h>
namespace fresco {
namespace {
/// Octree depth whose cells are as small as `cell` in a cube around the points.
int depthFor(const PointSet& points, double cell, double scale)
{
  const double side = (points.points.rowwise().maxCoeff() - points.points.rowwise().minCoeff()).maxCoeff() * scale;
  return std::clamp(static_cast<int>(std::ceil(std::log2(side / cell))), 2, 16);
}
} // namespace

nlohmann::ordered_json makeSurface(const ModelFiles& files, const ModelOptions& options, const Progress& progress)
{
  report(progress, "read", 0.0);
  const PointSet points = readPoints(files.points);
  VolumetricOptions volumetric;
  volumetric.cell_size = options.cell;
  volumetric.threads = options.threads;
  if (options.trim > 0)
    volumetric.trim =
        std::max(0.f, static_cast<float>(depthFor(points, options.cell, volumetric.scale) - options.trim));
  const VolumetricResult result = reconstructVolumetric(points, volumetric, progress);
  if (result.mesh.faceCount() == 0)
    throw std::runtime_error(files.points + ": no surface could be made of the points");
  writeMesh(files.surface, result.mesh);
  const MeshTopology topology = meshTopology(result.mesh);
  return {{"vertices", result.mesh.vertexCount()},
          {"faces", result.mesh.faceCount()},
          {"octree_depth", result.depth},
          {"cell", result.cell_size},
          {"components", topology.components},
          {"boundary_edges", topology.boundary_edges},
          {"non_manifold_edges", topology.nonmanifold_edges},
          {"watertight", topology.watertight}};
}
} // namespace fresco
