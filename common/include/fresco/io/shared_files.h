// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/exchange.h>
#include <fresco/core/export.h>
#include <string>
#include <vector>
namespace fresco {
/// @param name what the message begins with
/// @throws std::runtime_error on all ranks if one of them finds files of other
/// names or sizes
FRESCO_EXPORT void requireSameFiles(const std::vector<std::string>& files, const std::string& name, Exchange& ranks);
} // namespace fresco
