// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/pcl_conversions.h>
#include <fresco/core/require.h>
#include <fresco/deliverables/mesh_simplification.h>
#include <utility>
namespace fresco {
inline void MeshSimplification::process(pcl::PolygonMesh& output)
{
  require(input_mesh_ != nullptr, "MeshSimplification: no input mesh");
  pcl::PolygonMesh simplified; // the base class clears its output first, which may be the input
  pcl::MeshProcessing::process(simplified);
  output = std::move(simplified);
}

inline void MeshSimplification::performProcessing(pcl::PolygonMesh& output)
{
  toPolygonMesh(simplifyMesh(toTriangleMesh(*input_mesh_), options_, &figures_, progress_), output);
}
} // namespace fresco
