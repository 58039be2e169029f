// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "pipeline.h"
namespace fresco::model {
/// One line with time, memory and figures of a stage.
std::string stageSummary(const StageRecord& stage);

/// report.json: times, memory and figures per stage, and report.html: the same with the pictures inside, readable
/// offline.
void writeReport(const ModelReport& report, const ModelFiles& files);
} // namespace fresco::model
