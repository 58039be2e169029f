// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/pcl_conversions.h>
#include <fresco/core/require.h>
#include <fresco/registration/scan_registration.h>
#include <pcl/common/transforms.h>
#include <pcl/point_types.h>
namespace fresco {
namespace detail {
template <typename PointT>
void transformCloud(const pcl::PointCloud<PointT>& cloud, const Eigen::Matrix4d& T, pcl::PointCloud<PointT>& output)
{
  const Eigen::Matrix4f transform = T.cast<float>();
  if constexpr (pcl::traits::has_normal<PointT>::value)
    pcl::transformPointCloudWithNormals(cloud, output, transform);
  else
    pcl::transformPointCloud(cloud, output, transform);
  output.sensor_origin_ = Eigen::Vector4f(0.f, 0.f, 0.f, 0.f);
  output.sensor_origin_.template head<3>() =
      (transform * Eigen::Vector4f(cloud.sensor_origin_[0], cloud.sensor_origin_[1], cloud.sensor_origin_[2], 1.f))
          .template head<3>();
  output.sensor_orientation_ =
      Eigen::Quaternionf(Eigen::Matrix3f(transform.template topLeftCorner<3, 3>())) * cloud.sensor_orientation_;
}
} // namespace detail

template <typename PointT>
std::size_t ScanRegistration<PointT>::addPointCloud(const PointCloudConstPtr& cloud,
                                                    const std::optional<Eigen::Matrix4d>& start)
{
  require(cloud != nullptr, "scan registration: the cloud is null");
  clouds_.push_back(cloud);
  start_.push_back(start);
  return clouds_.size() - 1;
}

template <typename PointT>
void ScanRegistration<PointT>::clear()
{
  clouds_.clear();
  start_.clear();
  result_ = {};
}

template <typename PointT>
const ScanRegistrationResult& ScanRegistration<PointT>::compute(const Progress& progress)
{
  std::vector<PointSet> scans;
  for (const PointCloudConstPtr& cloud : clouds_)
    scans.push_back(toPointSet(*cloud));
  return result_ = registerScans(scans, start_, options_, progress);
}

template <typename PointT>
Eigen::Matrix4d ScanRegistration<PointT>::getTransformation(std::size_t scan) const
{
  require(scan < result_.poses.size(), "scan registration: scan ", scan, " of ", result_.poses.size());
  require(result_.poses[scan].has_value(), "scan registration: scan ", scan, " has no place");
  return *result_.poses[scan];
}

template <typename PointT>
typename ScanRegistration<PointT>::PointCloud ScanRegistration<PointT>::getTransformedCloud(std::size_t scan) const
{
  PointCloud moved;
  detail::transformCloud(*clouds_.at(scan), getTransformation(scan), moved);
  return moved;
}

template <typename PointT>
typename ScanRegistration<PointT>::PointCloud ScanRegistration<PointT>::getConcatenatedCloud() const
{
  PointCloud merged;
  for (std::size_t i = 0; i < result_.poses.size(); ++i)
    if (isPlaced(i))
      merged += getTransformedCloud(i);
  return merged;
}
} // namespace fresco
