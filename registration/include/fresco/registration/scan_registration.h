// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/registration/core/scan_registration.h>
#include <optional>
#include <pcl/memory.h>
#include <pcl/point_cloud.h>
namespace fresco {
/// PCL face of registerScans(): many scans, start poses optional. A scan's viewpoint is vp_x vp_y vp_z of its points,
/// else the cloud's sensor_origin_. The clouds are never changed.
template <typename PointT>
class ScanRegistration {
public:
  using PointCloud = pcl::PointCloud<PointT>;
  using PointCloudConstPtr = typename PointCloud::ConstPtr;
  using Ptr = pcl::shared_ptr<ScanRegistration>;
  using ConstPtr = pcl::shared_ptr<const ScanRegistration>;

  /// @param start world from scan, 4x4 rigid; without one, the scan is aligned globally
  /// @return number of the scan
  /// @throws std::invalid_argument if the cloud is null
  std::size_t addPointCloud(const PointCloudConstPtr& cloud,
                            const std::optional<Eigen::Matrix4d>& start = std::nullopt);
  std::size_t getNumberOfPointClouds() const { return clouds_.size(); }
  void clear();

  /// Setters: see ScanRegistrationOptions.
  void setVoxelSize(float voxel) { options_.voxel = voxel; }
  float getVoxelSize() const { return options_.voxel; }
  void setMaxCorrespondenceDistance(float distance) { options_.max_distance = distance; }
  float getMaxCorrespondenceDistance() const { return options_.max_distance; }
  void setMinOverlap(float share) { options_.min_overlap = share; }
  float getMinOverlap() const { return options_.min_overlap; }
  void setFixed(bool fixed) { options_.fixed = fixed; }
  bool getFixed() const { return options_.fixed; }
  void setUpright(bool upright) { options_.upright = upright; }
  bool getUpright() const { return options_.upright; }
  void setMaxViolation(float share) { options_.max_violation = share; }
  float getMaxViolation() const { return options_.max_violation; }
  void setConfidence(double probability) { options_.confidence = probability; }
  double getConfidence() const { return options_.confidence; }
  void setMaximumIterations(int iterations) { options_.max_iterations = iterations; }
  int getMaximumIterations() const { return options_.max_iterations; }
  void setNumberOfThreads(int threads) { options_.threads = threads; }
  int getNumberOfThreads() const { return options_.threads; }
  void setThreads(int threads) { setNumberOfThreads(threads); } ///< the name that pcl::Poisson has
  int getThreads() const { return getNumberOfThreads(); }
  void setOptions(const ScanRegistrationOptions& options) { options_ = options; }
  const ScanRegistrationOptions& getOptions() const { return options_; }
  void setProgress(Progress progress) { progress_ = std::move(progress); }
  const Progress& getProgress() const { return progress_; }

  /// @throws see registerScans()
  const ScanRegistrationResult& compute() { return compute(progress_); }
  const ScanRegistrationResult& compute(const Progress& progress); ///< once with another progress

  bool isPlaced(std::size_t scan) const { return result_.poses.at(scan).has_value(); }
  /// World from scan.
  /// @throws std::invalid_argument unless the scan is placed
  Eigen::Matrix4d getTransformation(std::size_t scan) const;
  /// The scan in the world; `sensor_origin_` moves with it.
  PointCloud getTransformedCloud(std::size_t scan) const;
  /// All placed scans in the world, every field of PointT kept.
  PointCloud getConcatenatedCloud() const;
  const ScanRegistrationResult& getResult() const { return result_; }

private:
  std::vector<PointCloudConstPtr> clouds_;
  std::vector<Pose> start_;
  ScanRegistrationOptions options_;
  Progress progress_;
  ScanRegistrationResult result_;
};
} // namespace fresco
#include <fresco/registration/impl/scan_registration.hpp>
