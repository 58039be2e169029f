// SPDX-License-Identifier: BSD-3-Clause
#pragma once
namespace fresco {
constexpr double pi = 3.14159265358979323846;
constexpr double radians_per_degree = pi / 180;
constexpr double degrees_per_radian = 180 / pi;
} // namespace fresco
