// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/pcl_conversions.h>
#include <fresco/filters/veil_point_removal.h>
namespace fresco {
template <typename PointT>
void VeilPointRemoval<PointT>::applyFilter(pcl::Indices& indices)
{
  const PointSet set = toPointSet(*this->input_, *this->indices_);
  const Points viewpoints = viewpoint_ ? Points(*viewpoint_) : set.viewpoints;
  std::vector<char> stays(set.size(), 0);
  for (const Index i : withoutMixedPixels(set.points, viewpoints, options_, progress_))
    stays[i] = 1;
  indices.clear();
  this->removed_indices_->clear();
  for (Index i = 0; i < set.size(); ++i) {
    const bool wanted = (stays[i] != 0) != this->negative_ && set.points.col(i).allFinite();
    if (wanted)
      indices.push_back((*this->indices_)[i]);
    else if (this->extract_removed_indices_)
      this->removed_indices_->push_back((*this->indices_)[i]);
  }
}

template <typename PointT>
void VeilPointRemoval<PointT>::applyFilter(PointCloud& output)
{
  pcl::FilterIndices<PointT>::applyFilter(output);
  if (!this->keep_organized_)
    output.is_dense = true; // non-finite points are gone
}
} // namespace fresco
