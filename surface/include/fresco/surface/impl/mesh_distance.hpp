// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/pcl_conversions.h>
#include <fresco/core/require.h>
#include <fresco/surface/core/error_colors.h>
#include <fresco/surface/mesh_distance.h>
#include <utility>
namespace fresco {
inline void MeshDistance::process(pcl::PolygonMesh& output)
{
  require(input_mesh_ != nullptr, "MeshDistance: no input mesh");
  pcl::PolygonMesh colored; // the base class clears its output first, which may be the input
  pcl::MeshProcessing::process(colored);
  output = std::move(colored);
}

inline const MeshDistanceResult& MeshDistance::compute()
{
  measureInput();
  return result_;
}

// The input mesh, measured into result_.
inline TriangleMesh MeshDistance::measureInput()
{
  require(input_mesh_ != nullptr, "MeshDistance: no input mesh");
  require(reference_ != nullptr, "MeshDistance: no reference mesh");
  TriangleMesh mesh = toTriangleMesh(*input_mesh_);
  result_ = measureMeshDistance(mesh, toTriangleMesh(*reference_), options_, progress_);
  return mesh;
}

inline void MeshDistance::performProcessing(pcl::PolygonMesh& output)
{
  TriangleMesh mesh = measureInput();
  const float largest = largest_color_ > 0.f ? largest_color_ : static_cast<float>(result_.vertices.to_reference.max);
  mesh.colors = errorColors(result_.vertex_distances, largest);
  mesh.fields["distance"] = result_.vertex_distances;
  toPolygonMesh(mesh, output);
}
} // namespace fresco
