// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/pcl_conversions.h>
#include <fresco/core/require.h>
#include <fresco/surface/surface_optimization.h>
#include <utility>
namespace fresco {
template <typename PointT>
void SurfaceOptimization::setInputCloud(const pcl::shared_ptr<const pcl::PointCloud<PointT>>& cloud)
{
  require(cloud != nullptr, "SurfaceOptimization: no input cloud");
  points_ = toPointSet(*cloud);
}

template <typename PointT>
void SurfaceOptimization::setInputCloud(const pcl::shared_ptr<pcl::PointCloud<PointT>>& cloud)
{
  setInputCloud(pcl::shared_ptr<const pcl::PointCloud<PointT>>(cloud));
}

inline void SurfaceOptimization::process(pcl::PolygonMesh& output)
{
  require(input_mesh_ != nullptr, "SurfaceOptimization: no input mesh");
  require(points_.size() > 0, "SurfaceOptimization: no input cloud");
  pcl::PolygonMesh moved; // the base class clears its output first, which may be the input
  pcl::MeshProcessing::process(moved);
  output = std::move(moved);
}

inline const SurfaceOptimizationResult& SurfaceOptimization::getResult() const
{
  if (result_mode_ == OptimizationMode::energy)
    return energy_result_;
  return filtering_result_;
}

inline void SurfaceOptimization::performProcessing(pcl::PolygonMesh& output)
{
  const auto put = [&](auto& result, auto optimized) {
    toPolygonMesh(optimized.mesh, output);
    optimized.mesh = {};
    result = std::move(optimized);
  };
  const TriangleMesh mesh = toTriangleMesh(*input_mesh_);
  if (isEnergy())
    put(energy_result_, minimizeSurfaceEnergy(mesh, points_, energy_, progress_));
  else
    put(filtering_result_, filterSurface(mesh, points_, filtering_, progress_));
  result_mode_ = mode_;
}
} // namespace fresco
