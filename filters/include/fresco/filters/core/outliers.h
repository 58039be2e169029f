// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/types.h>
#include <vector>
namespace fresco {
struct OutlierOptions {
  int k = 16;            ///< neighbours, >= 1, the point not counted
  float sigma = 2;       ///< standard deviations above the mean that make an outlier, finite
  bool relative = false; ///< judge distances against those of the neighbours, so that sparse parts of a scan stay
  int threads = 0;       ///< 0 = all cores; the result does not depend on it
};

/// Statistical outliers: points whose mean distance to their k neighbours exceeds the mean of all points by more than
/// `sigma` standard deviations (Rusu et al. 2008, "Towards 3D point cloud based object maps for household
/// environments"; the rule of pcl::StatisticalOutlierRemoval). With `relative`, the rule is applied to the logarithm of
/// the ratio of a point's mean distance to the median of its neighbours' mean distances, which does not change with the
/// density of the scan.
/// @return indices of the points that stay, ascending; finite ones only
/// @throws std::invalid_argument if an option is out of range
FRESCO_EXPORT std::vector<Index> withoutOutliers(const Points& points, const OutlierOptions& options = {});

struct ScatterOptions {
  int k = 16;             ///< neighbours that tell the spacing at a point, >= 2; 3 k of its peers tell their dimension
  float dimension = 2.6f; ///< of what goes: surfaces have 2, a volume 3; more removes less, above 0
  int threads = 0;        ///< 0 = all cores; the result does not depend on it
};

/// Scattered points: those that fill a volume among the points spaced as widely as they are, or wider.
/// @return indices of the points that stay, ascending; finite ones only
/// @throws std::invalid_argument if an option is out of range
FRESCO_EXPORT std::vector<Index> withoutScatter(const Points& points, const ScatterOptions& options = {});
} // namespace fresco
