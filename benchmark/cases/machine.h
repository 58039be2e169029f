// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
namespace fresco::benchmark {
/// Date, processor, cores, memory, load and operating system, as lines of a markdown list.
std::string machineText();
} // namespace fresco::benchmark
