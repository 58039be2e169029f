// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/pcl_conversions.h>
#include <pcl/conversions.h>
#include <pcl/for_each_type.h>
#include <pcl/point_types.h>
namespace fresco {
namespace core {
/// Points of a registered type as bytes.
struct PointBytes {
  const void* data;
  std::size_t count;  ///< points
  std::size_t stride; ///< bytes from point to point
};

/// @param indices nullptr: all points
FRESCO_EXPORT PointSet pointsFromBytes(const std::vector<pcl::PCLPointField>& fields, const PointBytes& bytes,
                                       const pcl::Indices* indices);

/// Writes what `fields` have room for to `data`, set.size() points that are `stride` bytes apart.
FRESCO_EXPORT void pointsToBytes(const PointSet& set, const std::vector<pcl::PCLPointField>& fields, void* data,
                                 std::size_t stride);

template <typename PointT>
std::vector<pcl::PCLPointField> fieldsOf()
{
  static_assert(pcl::traits::has_xyz<PointT>::value, "the point type needs the fields x y z");
  std::vector<pcl::PCLPointField> fields;
  pcl::for_each_type<typename pcl::traits::fieldList<PointT>::type>(pcl::detail::FieldAdder<PointT>(fields));
  return fields;
}

template <typename PointT>
PointSet pointsOf(const pcl::PointCloud<PointT>& cloud, const pcl::Indices* indices)
{
  PointSet set = pointsFromBytes(fieldsOf<PointT>(), {cloud.points.data(), cloud.size(), sizeof(PointT)}, indices);
  if (set.viewpoints.cols() == 0)
    set.viewpoints = cloud.sensor_origin_.template head<3>();
  return set;
}
} // namespace core

template <typename PointT>
PointSet toPointSet(const pcl::PointCloud<PointT>& cloud)
{
  return core::pointsOf(cloud, nullptr);
}

template <typename PointT>
PointSet toPointSet(const pcl::PointCloud<PointT>& cloud, const pcl::Indices& indices)
{
  return core::pointsOf(cloud, &indices);
}

template <typename PointT>
void toPointCloud(const PointSet& set, pcl::PointCloud<PointT>& cloud)
{
  cloud.points.assign(set.size(), PointT());
  cloud.width = static_cast<std::uint32_t>(set.size());
  cloud.height = 1;
  cloud.is_dense = set.points.allFinite();
  cloud.sensor_origin_.setZero();
  if (set.viewpoints.cols() == 1)
    cloud.sensor_origin_.template head<3>() =
        (set.origin + set.viewpoints.col(0).template cast<double>()).template cast<float>();
  cloud.sensor_orientation_.setIdentity();
  core::pointsToBytes(set, core::fieldsOf<PointT>(), cloud.points.data(), sizeof(PointT));
}
} // namespace fresco
