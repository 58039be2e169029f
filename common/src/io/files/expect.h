// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/require.h>
namespace fresco {
/// Check of what a file holds, as require() is one of arguments. Write the condition so that NaN fails it.
/// @throws std::runtime_error with all `parts` joined if `ok` is false
template <typename... Parts>
void expect(bool ok, const Parts&... parts)
{
  if (!ok)
    throw std::runtime_error(concat(parts...));
}
} // namespace fresco
