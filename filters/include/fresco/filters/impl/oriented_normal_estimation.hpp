// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/parallel.h>
#include <fresco/core/pcl_conversions.h>
#include <fresco/core/require.h>
#include <fresco/filters/oriented_normal_estimation.h>
#include <fresco/search/neighbors.h>
#include <pcl/common/copy_point.h>
#include <pcl/common/point_tests.h>
namespace fresco {
/// As the base class does, but without a tree of its own, and with a default of k.
template <typename PointInT, typename PointOutT>
bool OrientedNormalEstimation<PointInT, PointOutT>::initCompute()
{
  if (!pcl::PCLBase<PointInT>::initCompute())
    return false;
  require(this->k_ == 0 || this->search_radius_ == 0, "normals: both radius and k are set");
  if (this->input_->empty())
    return false;
  if (!this->surface_) {
    this->fake_surface_ = true;
    this->surface_ = this->input_;
  }
  return true;
}

template <typename PointInT, typename PointOutT>
PointSet OrientedNormalEstimation<PointInT, PointOutT>::scanOf(const pcl::PointCloud<PointInT>& cloud) const
{
  PointSet set = toPointSet(cloud);
  if (viewpoint_)
    set.viewpoints = *viewpoint_;
  else if (unknown_)
    set.viewpoints.resize(3, 0);
  return set;
}

/// For each index, the point of the surface whose normal it takes; -1 for non-finite points.
template <typename PointInT, typename PointOutT>
std::vector<Index> OrientedNormalEstimation<PointInT, PointOutT>::placesOnSurface(const PointSet& surface) const
{
  std::vector<Index> places;
  if (this->surface_ == this->input_) {
    for (const auto index : *this->indices_) {
      require(index >= 0 && index < surface.size(), "normals: index ", index, " is not in 0..", surface.size() - 1);
      places.push_back(index);
    }
    return places;
  }
  const PointTree tree(surface.points, options_.threads);
  const PointSet wanted = toPointSet(*this->input_, *this->indices_);
  for (Index i = 0; i < wanted.size(); ++i)
    places.push_back(tree.nearest(wanted.points.col(i)).index);
  return places;
}

/// Those that our own search finds, too: within the radius at least 6 and at most 256, evenly chosen.
template <typename PointInT, typename PointOutT>
pcl::Indices OrientedNormalEstimation<PointInT, PointOutT>::searchNeighbors(const PointInT& point,
                                                                            const NormalOptions& options) const
{
  pcl::Indices found;
  std::vector<float> squared;
  if (options.radius == 0) {
    this->tree_->nearestKSearch(point, options.k, found, squared);
    return found;
  }
  this->tree_->radiusSearch(point, options.radius, found, squared);
  if (found.size() < fewest_within)
    this->tree_->nearestKSearch(point, fewest_within, found, squared);
  if (found.size() <= most_within)
    return found;
  pcl::Indices some;
  for (std::size_t j = 0; j < most_within; ++j)
    some.push_back(found[j * found.size() / most_within]);
  return some;
}

/// By setSearchMethod(), of the points of the surface.
template <typename PointInT, typename PointOutT>
NeighborLists OrientedNormalEstimation<PointInT, PointOutT>::searchAllNeighbors(const NormalOptions& options) const
{
  const auto& surface = *this->surface_;
  if (this->tree_->getInputCloud() != this->surface_)
    this->tree_->setInputCloud(this->surface_);
  std::vector<pcl::Indices> found(surface.size());
  parallelFor(found.size(), options.threads, [&](Index i) {
    if (pcl::isXYZFinite(surface[i]))
      found[i] = searchNeighbors(surface[i], options);
  });
  NeighborLists lists;
  lists.begin.assign(1, 0);
  for (const pcl::Indices& list : found) {
    lists.index.insert(lists.index.end(), list.begin(), list.end());
    lists.begin.push_back(lists.index.size());
  }
  return lists;
}

template <typename PointInT, typename PointOutT>
void OrientedNormalEstimation<PointInT, PointOutT>::computeFeature(PointCloudOut& output)
{
  NormalOptions options = options_;
  if (this->search_radius_ != 0)
    options.radius = this->search_radius_;
  else if (this->k_ != 0)
    options.k = this->k_, options.radius = 0;
  if (this->surface_->isOrganized())
    options.image_width = this->surface_->width;
  const PointSet surface = scanOf(*this->surface_);
  const std::vector<Index> places = placesOnSurface(surface);
  const NormalField field = this->tree_
                                ? estimateNormalsFromNeighbors(surface, searchAllNeighbors(options), options, progress_)
                                : estimateNormals(surface, options, progress_);
  output.sensor_origin_ = this->input_->sensor_origin_;
  output.sensor_orientation_ = this->input_->sensor_orientation_;
  confidences_.setZero(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    PointOutT& point = output[i];
    pcl::copyPoint((*this->input_)[(*this->indices_)[i]], point);
    const bool found = places[i] >= 0;
    point.getNormalVector3fMap() =
        found ? Eigen::Vector3f(field.normals.col(places[i])) : Eigen::Vector3f::Constant(NAN);
    point.curvature = found ? field.curvatures[places[i]] : NAN;
    confidences_[i] = found ? field.confidences[places[i]] : 0.f;
    output.is_dense = output.is_dense && pcl::isNormalFinite(point);
  }
}
} // namespace fresco
