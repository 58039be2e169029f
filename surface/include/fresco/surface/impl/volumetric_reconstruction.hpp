// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/pcl_conversions.h>
#include <fresco/core/require.h>
#include <fresco/surface/volumetric_reconstruction.h>
#include <utility>
namespace fresco {
template <typename PointNT>
void VolumetricReconstruction<PointNT>::begin()
{
  require(this->input_ != nullptr, "VolumetricReconstruction: no input cloud");
  require(!this->input_->empty(), "VolumetricReconstruction: the input cloud is empty");
  require(this->initCompute(), "VolumetricReconstruction: the indices do not fit the input cloud");
}

template <typename PointNT>
TriangleMesh VolumetricReconstruction<PointNT>::computeMesh()
{
  result_ = reconstructVolumetric(toPointSet(*this->input_, *this->indices_), options_, progress_);
  TriangleMesh mesh = std::move(result_.mesh);
  result_.mesh = {};
  return mesh;
}

template <typename PointNT>
std::size_t VolumetricReconstruction<PointNT>::estimateMemory()
{
  begin();
  return fresco::estimateMemory(toPointSet(*this->input_, *this->indices_), options_);
}

template <typename PointNT>
void VolumetricReconstruction<PointNT>::reconstruct(pcl::PolygonMesh& output)
{
  begin();
  performReconstruction(output);
  this->deinitCompute();
}

template <typename PointNT>
void VolumetricReconstruction<PointNT>::reconstruct(pcl::PointCloud<PointNT>& points,
                                                    std::vector<pcl::Vertices>& polygons)
{
  begin();
  performReconstruction(points, polygons);
  this->deinitCompute();
}

template <typename PointNT>
void VolumetricReconstruction<PointNT>::performReconstruction(pcl::PolygonMesh& output)
{
  toPolygonMesh(computeMesh(), output);
  output.header = this->input_->header;
  output.cloud.header = this->input_->header;
}

template <typename PointNT>
void VolumetricReconstruction<PointNT>::performReconstruction(pcl::PointCloud<PointNT>& points,
                                                              std::vector<pcl::Vertices>& polygons)
{
  const TriangleMesh mesh = computeMesh();
  PointSet set;
  set.origin = mesh.origin;
  set.points = mesh.vertices;
  set.normals = vertexNormals(mesh, options_.threads);
  set.colors = mesh.colors;
  if (const auto found = mesh.fields.find("intensity"); found != mesh.fields.end())
    set.intensities = found->second;
  toPointCloud(set, points);
  points.header = this->input_->header;
  points.sensor_origin_ = this->input_->sensor_origin_;
  points.sensor_orientation_ = this->input_->sensor_orientation_;
  polygons.resize(mesh.faceCount());
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const Eigen::Vector3i face = mesh.faces.col(f);
    polygons[f].vertices.assign(face.begin(), face.end());
  }
}
} // namespace fresco
