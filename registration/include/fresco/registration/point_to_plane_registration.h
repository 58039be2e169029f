// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/registration/core/point_to_plane_registration.h>
#include <limits>
#include <pcl/registration/registration.h>
namespace fresco {
/// PCL face of alignPointToPlane(): local registration of a pair. Normals are estimated (their sign from vp_x vp_y vp_z
/// or the cloud's sensor_origin_), so that PointSource and PointTarget need none. Honours setIndices() and leaves out
/// non-finite points. setMaxCorrespondenceDistance() is the reach at the start (without it: 20 voxels),
/// setMaximumIterations() counts per resolution, setTransformationEpsilon() is the square of the motion that ends a
/// resolution. RANSAC and fitness epsilons, minimum correspondences and the search methods are accepted and without
/// effect on align(); getFitnessScore() uses the target's search method.
template <typename PointSource, typename PointTarget>
class PointToPlaneRegistration : public pcl::Registration<PointSource, PointTarget> {
public:
  using Base = pcl::Registration<PointSource, PointTarget>;
  using Ptr = pcl::shared_ptr<PointToPlaneRegistration>;
  using ConstPtr = pcl::shared_ptr<const PointToPlaneRegistration>;
  using typename Base::Matrix4;
  using typename Base::PointCloudSource;

  PointToPlaneRegistration();

  void setVoxelSize(float voxel);
  float getVoxelSize() const { return voxel_; } ///< length; 0 = from the data
  void setNumberOfSamples(Index samples) { options_.samples = samples; }
  Index getNumberOfSamples() const { return options_.samples; }
  void setNumberOfThreads(int threads) { options_.threads = threads; }
  int getNumberOfThreads() const { return options_.threads; }

  /// Of the last align(); its transform is the one of getFinalTransformation().
  const PointToPlaneResult& getResult() const { return result_; }

  /// As in pcl::Registration, but without the points that are not finite, which abort PCL's search.
  double getFitnessScore(double max_range = std::numeric_limits<double>::max());

protected:
  /// @throws std::invalid_argument if a cloud has too few finite points
  void computeTransformation(PointCloudSource& output, const Matrix4& guess) override;

private:
  void prepare();

  PointToPlaneOptions options_;
  PointToPlaneResult result_;
  float voxel_ = 0.f;
  float prepared_voxel_ = 0.f;
  typename Base::PointCloudTargetConstPtr prepared_target_cloud_; ///< that prepared_target_ was made of
  std::shared_ptr<const registration::PreparedScan> prepared_source_, prepared_target_;
};
} // namespace fresco
#include <fresco/registration/impl/point_to_plane_registration.hpp>
