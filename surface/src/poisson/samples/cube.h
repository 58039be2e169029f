// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/samples/samples.h"
#include <Eigen/Geometry>
#include <fresco/core/point_stream.h>
#include <limits>
namespace fresco::poisson {
/// Weight of a point, 1 on average.
struct Weights {
  enum class Source { none, confidences, normal_lengths } source = Source::none;
  double scale = 1.0;

  float given(const PointSet& set, Index i) const; ///< before it is scaled
  double of(const PointSet& set, Index i) const { return scale * given(set, i); }
};

/// What the points of a stream have in common.
struct Extent {
  Index windows = 0; ///< with points
  Index all = 0;     ///< points
  Index usable = 0;  ///< that are finite, have a normal and a weight, and are no far outliers
  Weights weights;
  Eigen::AlignedBox3d allowed = Eigen::AlignedBox3d(Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity()),
                                                    Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()));
  Cube cube;
  double cells_per_unit = 1.0; ///< finest cells of the cube
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  bool colors = false, intensities = false;
  float largest_intensity = 0.f; ///< absolute

  bool isUsable(const PointSet& set, Index i) const
  {
    const float length = set.normals.col(i).squaredNorm();
    return set.points.col(i).allFinite() && std::isfinite(length) && length > 1e-20f && weights.given(set, i) > 0.f &&
           allowed.contains(set.points.col(i).cast<double>());
  }
};

/// Reads the points once, or twice if there are far outliers.
/// @throws std::invalid_argument as reconstructVolumetric()
/// @param points of this rank; the extent is that of all ranks' points
Extent findExtent(const PointStream& points, const VolumetricOptions& options, Exchange& exchange = onlyRank());
} // namespace fresco::poisson
