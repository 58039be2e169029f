// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
#include <vector>
namespace fresco::simulation {
/// Names of the layouts that writeLayout() knows, those that fresco_model reads: docs/inputs.md.
std::vector<std::string> layoutNames();

/// Writes a dataset of writeDataset() as another program or device would have laid it out, into `folder`.
/// @param source has what the layout is made of: scans/ and poses.txt; images/ and cameras/; panoramas/; or rgbd/ with poses.txt
/// @throws std::invalid_argument for a name that is none, std::runtime_error "PATH: reason" for a file that is missing or cannot be
///         written
void writeLayout(const std::string& name, const std::string& source, const std::string& folder);
} // namespace fresco::simulation
