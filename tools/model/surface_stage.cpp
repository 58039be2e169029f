// SPDX-License-Identifier: BSD-3-Clause
#include "model/surface_stage.h"
#include <fresco/common/mesh_io.h>
#include <fresco/common/point_io.h>
#include <fresco/common/require.h>
#include <fresco/surface/core/volumetric_reconstruction.h>
namespace fresco {
nlohmann::ordered_json makeSurface(const ModelFiles& files, const ModelOptions& options, const Progress& progress)
{
  report(progress, "read", 0.0);
  PointSet points = readPoints(files.points);
  VolumetricOptions volumetric;
  volumetric.cell_size = options.cell;
  volumetric.threads = options.threads;
  volumetric.trim_levels = static_cast<float>(options.trim);
  const VolumetricResult result = reconstructVolumetric(std::move(points), volumetric, progress);
  if (result.mesh.faceCount() == 0)
    throw std::runtime_error(files.points + ": no surface could be made of the points");
  writeMesh(files.surface, result.mesh);
  const MeshTopology topology = meshTopology(result.mesh);
  return {{"vertices", result.mesh.vertexCount()},
          {"faces", result.mesh.faceCount()},
          {"octree_depth", result.depth},
          {"cell", result.cell_size},
          {"trim_depth", result.trim_depth},
          {"components", topology.components},
          {"boundary_edges", topology.boundary_edges},
          {"non_manifold_edges", topology.nonmanifold_edges},
          {"watertight", topology.watertight}};
}
} // namespace fresco
