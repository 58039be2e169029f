// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
namespace fresco {
/// "fresco 0.1.0 with PCL 1.13.0, Embree 3.13.5": the version of fresco, and of those of PCL, Embree, OpenCV and VTK that
/// this process has loaded, as they were when fresco was built.
std::string versionLine();
} // namespace fresco
