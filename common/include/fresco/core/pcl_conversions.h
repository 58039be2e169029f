// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/mesh.h>
#include <fresco/core/point_set.h>
#include <pcl/PolygonMesh.h>
#include <pcl/point_cloud.h>
#include <vector>
/// Between fresco's arrays and PCL's types. Nothing is left out: points stay in order and non-finite ones stay
/// non-finite, so that indices mean the same on both sides.
namespace fresco {
/// All that PointT has of: normals, rgb or rgba, intensity, confidence, vp_x vp_y vp_z. Without vp_x vp_y vp_z,
/// `viewpoints` is the cloud's sensor_origin_, for all points.
/// @tparam PointT a registered point type with x y z
template <typename PointT>
PointSet toPointSet(const pcl::PointCloud<PointT>& cloud);

/// The points named by `indices`, in that order.
/// @throws std::invalid_argument if an index is out of range
template <typename PointT>
PointSet toPointSet(const pcl::PointCloud<PointT>& cloud, const pcl::Indices& indices);

/// Fills the fields that both sides have; the rest of PointT is as its constructor leaves it. `origin` is added, so
/// that coordinates are rounded to float. One common viewpoint becomes sensor_origin_. The header is left as it is; the
/// cloud becomes unorganised, is_dense tells whether all points are finite.
template <typename PointT>
void toPointCloud(const PointSet& set, pcl::PointCloud<PointT>& cloud);

/// Vertices with float fields x y z (`origin` added), normal_x normal_y normal_z, rgb and the mesh's further fields.
/// Headers are left as they are.
FRESCO_EXPORT void toPolygonMesh(const TriangleMesh& mesh, pcl::PolygonMesh& polygons);

/// Polygons become fans; normals, colours and further fields of the vertices are kept.
/// @throws std::invalid_argument without x y z or if a polygon names a vertex that is not there
FRESCO_EXPORT TriangleMesh toTriangleMesh(const pcl::PolygonMesh& polygons);
} // namespace fresco
#include <fresco/core/impl/pcl_conversions.hpp>
