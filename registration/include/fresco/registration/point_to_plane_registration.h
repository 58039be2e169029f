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
/// resolution. Neighbours are searched with the trees of setSearchMethodTarget() and setSearchMethodSource(), without
/// them with PointTree. A tree holds the thinned points while align() runs, and the user's afterwards; one tree given
/// for both clouds serves the target. RANSAC and fitness epsilons and minimum correspondences are accepted and without
/// effect.
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
  void setThreads(int threads) { setNumberOfThreads(threads); } ///< the name that pcl::Poisson has
  int getThreads() const { return getNumberOfThreads(); }
  void setProgress(Progress progress) { progress_ = std::move(progress); }
  const Progress& getProgress() const { return progress_; }

  /// All options at once, those of pcl::Registration included.
  void setOptions(const PointToPlaneOptions& options);
  PointToPlaneOptions getOptions() const;

  /// Of the last align(); its transform is the one of getFinalTransformation().
  const PointToPlaneResult& getResult() const { return result_; }

  /// As in pcl::Registration, but without the points that are not finite, which abort PCL's search.
  double getFitnessScore(double max_range = std::numeric_limits<double>::max());

protected:
  /// @throws std::invalid_argument if a cloud has too few finite points
  void computeTransformation(PointCloudSource& output, const Matrix4& guess) override;

private:
  std::shared_ptr<NeighborSearch> targetSearch() const;
  std::shared_ptr<NeighborSearch> sourceSearch() const;
  void prepare();

  PointToPlaneOptions options_;
  PointToPlaneResult result_;
  Progress progress_;
  float voxel_ = 0.f;
  float prepared_voxel_ = 0.f;
  typename Base::KdTreePtr own_tree_;                             ///< of the base class: not the user's
  typename Base::KdTreeReciprocalPtr own_reciprocal_tree_;        ///< the same for the source
  typename Base::PointCloudTargetConstPtr prepared_target_cloud_; ///< that prepared_target_ was made of
  typename Base::KdTreePtr prepared_tree_;                        ///< with this tree
  std::shared_ptr<const registration::PreparedScan> prepared_source_, prepared_target_;
};
} // namespace fresco
#include <fresco/registration/impl/point_to_plane_registration.hpp>
