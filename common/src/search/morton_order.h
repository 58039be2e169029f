// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>
namespace fresco::search {
/// Columns of `points` along a Morton curve of 1024 cells per axis: neighbours in the order are neighbours in space.
/// Equal cells keep the order of the columns.
/// @param points 3xN, finite
std::vector<std::int32_t> mortonOrder(const Eigen::Matrix3Xd& points, int threads);
} // namespace fresco::search
