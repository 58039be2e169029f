// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cmath>
#include <fresco/core/pcl_conversions.h>
#include <fresco/registration/impl/pcl_neighbor_search.hpp>
#include <fresco/registration/point_to_plane_registration.h>
#include <pcl/common/point_tests.h>
#include <pcl/common/transforms.h>
namespace fresco {
template <typename PointSource, typename PointTarget>
PointToPlaneRegistration<PointSource, PointTarget>::PointToPlaneRegistration()
    : own_tree_(this->tree_), own_reciprocal_tree_(this->tree_reciprocal_)
{
  this->reg_name_ = "PointToPlaneRegistration";
  this->max_iterations_ = options_.max_iterations;
}

template <typename PointSource, typename PointTarget>
void PointToPlaneRegistration<PointSource, PointTarget>::setOptions(const PointToPlaneOptions& options)
{
  options_ = options;
  const double unlimited = std::sqrt(std::numeric_limits<double>::max());
  this->corr_dist_threshold_ = options.max_distance > 0.f ? options.max_distance : unlimited;
  this->max_iterations_ = options.max_iterations;
  const double min_motion = options.min_motion;
  this->transformation_epsilon_ = min_motion * min_motion;
}

template <typename PointSource, typename PointTarget>
PointToPlaneOptions PointToPlaneRegistration<PointSource, PointTarget>::getOptions() const
{
  PointToPlaneOptions options = options_;
  const double reach = this->corr_dist_threshold_, epsilon = this->transformation_epsilon_;
  options.max_distance = reach < std::sqrt(std::numeric_limits<double>::max()) ? reach : 0.f;
  options.max_iterations = this->max_iterations_;
  options.min_motion = std::sqrt(std::max(0.0, epsilon));
  return options;
}

template <typename PointSource, typename PointTarget>
std::shared_ptr<NeighborSearch> PointToPlaneRegistration<PointSource, PointTarget>::targetSearch() const
{
  return this->tree_ == own_tree_ ? nullptr : std::make_shared<detail::PclNeighborSearch<PointTarget>>(this->tree_);
}

template <typename PointSource, typename PointTarget>
std::shared_ptr<NeighborSearch> PointToPlaneRegistration<PointSource, PointTarget>::sourceSearch() const
{
  const void *source = this->tree_reciprocal_.get(), *target = this->tree_.get();
  if (this->tree_reciprocal_ == own_reciprocal_tree_ || source == target)
    return nullptr;
  return std::make_shared<detail::PclNeighborSearch<PointSource>>(this->tree_reciprocal_);
}

template <typename PointSource, typename PointTarget>
void PointToPlaneRegistration<PointSource, PointTarget>::setVoxelSize(float voxel)
{
  voxel_ = voxel;
  prepared_target_.reset();
}

// The target is prepared once for many sources, as PCL's own classes do. A source may have other indices each time.
template <typename PointSource, typename PointTarget>
void PointToPlaneRegistration<PointSource, PointTarget>::prepare()
{
  const PointSet source = toPointSet(*this->input_, *this->indices_);
  if (!prepared_target_ || prepared_target_cloud_ != this->target_ || prepared_tree_ != this->tree_) {
    const PointSet target = toPointSet(*this->target_);
    const float voxel = voxel_ > 0.f ? voxel_ : std::max(registrationVoxel(source), registrationVoxel(target));
    prepared_target_ = prepareForRegistration(target, voxel, options_.threads, targetSearch());
    prepared_target_cloud_ = this->target_;
    prepared_tree_ = this->tree_;
    prepared_voxel_ = voxel;
  }
  prepared_source_ = prepareForRegistration(source, prepared_voxel_, options_.threads, sourceSearch());
}

template <typename PointSource, typename PointTarget>
void PointToPlaneRegistration<PointSource, PointTarget>::computeTransformation(PointCloudSource& output,
                                                                               const Matrix4& guess)
{
  const detail::SearchInputGuard<PointTarget> target_input(this->tree_);
  const detail::SearchInputGuard<PointSource> source_input(this->tree_reciprocal_);
  prepare();
  result_ =
      alignPointToPlane({*prepared_source_, *prepared_target_, guess.template cast<double>()}, getOptions(), progress_);
  this->final_transformation_ = result_.T_target_source.template cast<typename Matrix4::Scalar>();
  this->transformation_ = this->final_transformation_ * guess.inverse();
  this->nr_iterations_ = result_.iterations;
  this->converged_ = result_.converged;
  pcl::transformPointCloud(PointCloudSource(output), output, this->final_transformation_);
}

template <typename PointSource, typename PointTarget>
double PointToPlaneRegistration<PointSource, PointTarget>::getFitnessScore(double max_range)
{
  PointCloudSource finite;
  for (const auto index : *this->indices_)
    if (pcl::isFinite((*this->input_)[index]))
      finite.push_back((*this->input_)[index]);
  pcl::transformPointCloud(PointCloudSource(finite), finite, this->final_transformation_);
  pcl::Indices nearest(1);
  std::vector<float> squared(1);
  double sum = 0.0, count = 0.0;
  for (const PointSource& point : finite) {
    PointTarget query;
    query.x = point.x;
    query.y = point.y;
    query.z = point.z;
    this->tree_->nearestKSearch(query, 1, nearest, squared);
    if (squared[0] <= max_range) {
      sum += squared[0];
      count += 1.0;
    }
  }
  return count > 0.0 ? sum / count : std::numeric_limits<double>::max();
}
} // namespace fresco
