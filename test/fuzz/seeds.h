// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
namespace fresco::fuzz {
/// Small sound inputs, `folder`/TARGET/NAME, for every target of targets().
/// @throws std::runtime_error naming the file that cannot be written
void writeSeeds(const std::string& folder);
} // namespace fresco::fuzz
