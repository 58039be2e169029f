// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <string>
namespace fresco {
/// Order of names in which numbers within them are compared as numbers: frame-9 comes before frame-10.
FRESCO_EXPORT bool isNaturallyBefore(const std::string& a, const std::string& b);
} // namespace fresco
