// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
#include <vector>
namespace fresco {
/// What a user may have meant by an option that a tool does not have: the tool's own name for an option of PCL's tools
/// (pcl_voxel_grid, pcl_outlier_removal, pcl_normal_estimation, pcl_poisson_reconstruction, pcl_icp), or the name that
/// differs by the fewest letters.
/// @param known options of the tool, without a dash
/// @return "; did you mean -voxel?" or nothing
std::string meantOption(const std::string& given, const std::vector<std::string>& known);
} // namespace fresco
