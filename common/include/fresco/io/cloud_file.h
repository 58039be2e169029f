// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <fresco/core/export.h>
#include <fresco/core/point_set.h>
#include <pcl/PCLPointCloud2.h>
#include <string>
namespace fresco {
/// A cloud with every field of its file, as PCL's tools keep it.
struct CloudFile {
  pcl::PCLPointCloud2 cloud;
  Eigen::Vector4f sensor_origin = Eigen::Vector4f::Zero(); ///< (x, y, z, 0)
  Eigen::Quaternionf sensor_orientation = Eigen::Quaternionf::Identity();
  bool has_sensor_pose = false; ///< whether the file says where the sensor was
};

/// PCD (ascii, binary, binary_compressed), PLY, legacy VTK polydata, OBJ, XYZ (also .txt, .asc) by extension. Every
/// value per point becomes a field under PCL's name for it: byte colours become packed rgb or rgba, nx ny nz become
/// normal_x normal_y normal_z. Fields keep their type; the coordinates of text formats become double where float would
/// lose more than 1e-6 of the extent. Non-finite points are kept; is_dense tells whether there are any. Organised
/// clouds stay so.
/// @throws std::runtime_error "PATH: reason" if the file is missing, empty, truncated, malformed or without points
FRESCO_EXPORT CloudFile readCloud(const std::string& path);

/// PCD (binary), PLY (binary) or XYZ by extension; whole or not at all. PCD always holds the sensor pose, PLY where it
/// is known or not the identity, XYZ never. Padding between fields is dropped.
/// @param compressed PCD as binary_compressed
/// @throws std::runtime_error "PATH: reason" if it cannot be written
/// @throws std::invalid_argument if fields, sizes and data of the cloud do not agree
FRESCO_EXPORT void writeCloud(const std::string& path, const CloudFile& file, bool compressed = false);

/// x y z of any type (float clouds keep origin zero; where float would lose more than 1e-6 of the extent of others,
/// `origin` is chosen), normals, rgb or rgba or red green blue, intensity, confidence, vp_x vp_y vp_z or the sensor's
/// origin (where the pose is known or not zero) as viewpoints. Points stay in order, non-finite ones included.
/// @throws std::invalid_argument without x y z, or if fields, sizes and data do not agree
FRESCO_EXPORT PointSet toPointSet(const CloudFile& file);

/// Fields x y z (double where `origin` is not zero), normal_x normal_y normal_z, rgb, intensity, confidence, vp_x vp_y
/// vp_z.
FRESCO_EXPORT CloudFile toCloudFile(const PointSet& set);
} // namespace fresco
