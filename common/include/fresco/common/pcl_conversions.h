// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/common/mesh.h>
#include <fresco/common/point_set.h>
#include <fresco/common/textured_mesh.h>
#include <pcl/PolygonMesh.h>
#include <pcl/TextureMesh.h>
#include <pcl/point_cloud.h>
#include <string>
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
void toPolygonMesh(const TriangleMesh& mesh, pcl::PolygonMesh& polygons);

/// Polygons become fans; normals, colours and further fields of the vertices are kept.
/// @throws std::invalid_argument without x y z or if a polygon names a vertex that is not there
TriangleMesh toTriangleMesh(const pcl::PolygonMesh& polygons);

/// One sub-mesh and material per atlas, then one for the faces without texture (if any). Texture coordinates stand
/// corner by corner, as pcl::visualization expects them, and tex_coord_indices name them, as pcl::io::saveOBJFile
/// expects. Vertices get normals if the mesh has none, which that function needs.
/// @param image_files tex_file of each material, one per atlas; empty: "texture_0.png", "texture_1.png" ...
void toTextureMesh(const TexturedMesh& model, pcl::TextureMesh& texture,
                   const std::vector<std::string>& image_files = {});

/// Sub-mesh i gets face_atlas i where its polygons have texture coordinates, else -1. Works with and without
/// tex_coord_indices.
/// @param atlases images of the materials, one per sub-mesh; empty: they are read from tex_file, found in `folder`
/// @throws std::invalid_argument if sizes do not agree, std::runtime_error if an image cannot be read
TexturedMesh toTexturedMesh(const pcl::TextureMesh& texture, const std::string& folder,
                            std::vector<Image> atlases = {});
} // namespace fresco
#include <fresco/common/impl/pcl_conversions.hpp>
