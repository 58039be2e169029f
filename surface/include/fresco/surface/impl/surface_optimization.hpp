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

inline void SurfaceOptimization::performProcessing(pcl::PolygonMesh& output)
{
  result_ = filterSurface(toTriangleMesh(*input_mesh_), points_, options_, progress_);
  toPolygonMesh(result_.mesh, output);
  result_.mesh = {};
}
} // namespace fresco
