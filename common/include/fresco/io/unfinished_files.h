// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
namespace fresco {
/// Removes what every OutputFile of this process has written and not committed: for a program that ends at once, without
/// unwinding. No OutputFile can be made or committed afterwards (the caller blocks for ever).
FRESCO_EXPORT void abandonUnfinishedFiles() noexcept;
} // namespace fresco
