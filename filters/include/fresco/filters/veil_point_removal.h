// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/filters/core/mixed_pixels.h>
#include <optional>
#include <pcl/filters/filter_indices.h>
#include <pcl/filters/impl/filter_indices.hpp>
namespace fresco {
/// PCL face of withoutMixedPixels(), which removes mixed pixels (veil points); setters: see MixedPixelOptions. The scan was seen from setViewPoint(), else from the points'
/// own vp_x vp_y vp_z, else from the cloud's sensor_origin_. Honours setIndices(), setNegative(), setKeepOrganized(),
/// setUserFilterValue() and the extraction of removed indices; points that are not finite are removed in both
/// polarities. filter() throws std::invalid_argument for an option out of range and an index that is not there.
/// @tparam PointT a point type with x y z
template <typename PointT>
class VeilPointRemoval : public pcl::FilterIndices<PointT> {
public:
  using Ptr = pcl::shared_ptr<VeilPointRemoval>;
  using ConstPtr = pcl::shared_ptr<const VeilPointRemoval>;
  using PointCloud = pcl::PointCloud<PointT>;

  explicit VeilPointRemoval(bool extract_removed_indices = false) : pcl::FilterIndices<PointT>(extract_removed_indices)
  {
    this->filter_name_ = "VeilPointRemoval";
  }

  void setAngle(float degrees) { options_.angle = degrees; }
  float getAngle() const { return options_.angle; }
  void setRangeNoise(float deviation) { options_.noise = deviation; } ///< 0 = measured
  float getRangeNoise() const { return options_.noise; }
  void setBeams(int k) { options_.k = k; }
  int getBeams() const { return options_.k; }
  void setViewPoint(float x, float y, float z) { viewpoint_ = Eigen::Vector3f(x, y, z); }
  void useSensorOriginAsViewPoint() { viewpoint_.reset(); } ///< the default: what the cloud says
  [[deprecated("useSensorOriginAsViewPoint()")]] void unsetViewPoint() { useSensorOriginAsViewPoint(); }
  void setOptions(const MixedPixelOptions& options) { options_ = options; }
  const MixedPixelOptions& getOptions() const { return options_; }
  void setNumberOfThreads(int threads) { options_.threads = threads; } ///< 0 = all cores
  int getNumberOfThreads() const { return options_.threads; }
  void setThreads(int threads) { setNumberOfThreads(threads); } ///< as pcl::Poisson has it
  int getThreads() const { return getNumberOfThreads(); }
  /// filter() throws Cancelled where it returns false.
  void setProgress(const Progress& progress) { progress_ = progress; }

protected:
  void applyFilter(pcl::Indices& indices) override;
  void applyFilter(PointCloud& output) override;

private:
  MixedPixelOptions options_;
  std::optional<Eigen::Vector3f> viewpoint_;
  Progress progress_;
};
} // namespace fresco
#include <fresco/filters/impl/veil_point_removal.hpp>
