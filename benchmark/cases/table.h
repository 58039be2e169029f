// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "cases/runner.h"
#include <nlohmann/json.hpp>
#include <string>
#include <vector>
namespace fresco::benchmark {
/// 0 of nothing.
double median(std::vector<double> values);

/// Markdown table, one row per measurement.
std::string markdownTable(const std::vector<Measurement>& measurements);

nlohmann::json measurementsJson(const std::vector<Measurement>& measurements);
} // namespace fresco::benchmark
