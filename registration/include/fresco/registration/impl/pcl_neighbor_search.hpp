// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <fresco/registration/core/neighbor_search.h>
#include <pcl/point_cloud.h>
#include <pcl/search/search.h>
namespace fresco::detail {
/// NeighborSearch by a search of PCL, whose input it replaces.
template <typename PointT>
class PclNeighborSearch : public NeighborSearch {
public:
  explicit PclNeighborSearch(typename pcl::search::Search<PointT>::Ptr search) : search_(std::move(search)) {}

  void setPoints(const Points& points) override
  {
    typename pcl::PointCloud<PointT>::Ptr cloud(new pcl::PointCloud<PointT>);
    cloud->resize(points.cols());
    for (Index i = 0; i < points.cols(); ++i)
      (*cloud)[i].getVector3fMap() = points.col(i);
    search_->setInputCloud(cloud);
  }

  void nearest(const Eigen::Vector3f& query, int k, std::vector<Neighbor>& found) const override
  {
    PointT point;
    point.getVector3fMap() = query;
    pcl::Indices indices;
    std::vector<float> squared;
    search_->nearestKSearch(point, k, indices, squared);
    found.resize(indices.size());
    for (std::size_t i = 0; i < indices.size(); ++i)
      found[i] = {indices[i], squared[i]};
    std::stable_sort(found.begin(), found.end(),
                     [](const Neighbor& a, const Neighbor& b) { return a.squared_distance < b.squared_distance; });
  }

private:
  typename pcl::search::Search<PointT>::Ptr search_;
};

/// Gives a search of PCL its input back.
template <typename PointT>
class SearchInputGuard {
public:
  using SearchPtr = typename pcl::search::Search<PointT>::Ptr;

  explicit SearchInputGuard(SearchPtr search)
      : search_(std::move(search)), cloud_(search_->getInputCloud()), indices_(search_->getIndices())
  {}
  SearchInputGuard(const SearchInputGuard&) = delete;
  SearchInputGuard& operator=(const SearchInputGuard&) = delete;
  ~SearchInputGuard()
  {
    if (cloud_ && search_->getInputCloud() != cloud_)
      search_->setInputCloud(cloud_, indices_);
  }

private:
  SearchPtr search_;
  typename pcl::search::Search<PointT>::PointCloudConstPtr cloud_;
  pcl::IndicesConstPtr indices_;
};
} // namespace fresco::detail
