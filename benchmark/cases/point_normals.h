// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/types.h>
namespace fresco::benchmark {
/// Unit normals by principal components of the `neighbours` closest points (pcl::NormalEstimation), turned to the side
/// that `facing` points to.
/// @param points 3xN, finite
/// @param facing 3xN
Points principalNormals(const Points& points, const Points& facing, int neighbours);
} // namespace fresco::benchmark
