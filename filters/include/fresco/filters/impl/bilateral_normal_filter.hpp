// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/pcl_conversions.h>
#include <fresco/filters/bilateral_normal_filter.h>
#include <pcl/common/io.h>
namespace fresco {
template <typename PointNT>
void BilateralNormalFilter<PointNT>::applyFilter(PointCloud& output)
{
  PointSet set = toPointSet(*this->input_, *this->indices_);
  if (viewpoint_)
    set.viewpoints = *viewpoint_;
  else if (!known_)
    set.viewpoints.resize(3, 0);
  const BilateralResult result = smoothNormals(set, set.normals, options_, progress_);
  if (this->fake_indices_)
    output = *this->input_;
  else
    pcl::copyPointCloud(*this->input_, *this->indices_, output);
  for (Index i = 0; i < set.size(); ++i) {
    PointNT& point = output[i];
    point.getVector3fMap() = result.points.col(i);
    point.getNormalVector3fMap() = result.normals.col(i);
  }
  this->removed_indices_->clear();
}
} // namespace fresco
