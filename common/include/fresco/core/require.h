// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <locale>
#include <sstream>
#include <stdexcept>
#include <string>
namespace fresco {
/// All parts printed one after the other, numbers alike in any locale.
template <typename... Parts>
std::string concat(const Parts&... parts)
{
  std::ostringstream text;
  text.imbue(std::locale::classic());
  (text << ... << parts);
  return text.str();
}

/// Argument check at the door of a public function. Write the condition so that NaN fails it.
/// @throws std::invalid_argument with all `parts` joined if `ok` is false
template <typename... Parts>
void require(bool ok, const Parts&... parts)
{
  if (!ok)
    throw std::invalid_argument(concat(parts...));
}
} // namespace fresco
