// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "stages/stages.h"
namespace fresco::model {
/// Points, time, memory and disk of a job, from headers and sizes of files. `stages` stays empty.
ModelPlan estimate(const Job& job);

/// @throws std::runtime_error if memory or the disk of the output folder clearly cannot hold what the job needs
void requireRoom(const ModelPlan& plan, const Job& job);
} // namespace fresco::model
