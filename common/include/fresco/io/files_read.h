// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <string>
#include <vector>
namespace fresco {
/// All files that this process has read so far, in the order of their names.
FRESCO_EXPORT std::vector<std::string> filesRead();
} // namespace fresco
