// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <fresco/core/require.h>
#include <vector>
namespace fresco {
/// "a, b and 3 more". @param most names that are told
inline std::string listed(const std::vector<std::string>& names, std::size_t most)
{
  std::string text;
  for (std::size_t k = 0; k < std::min(most, names.size()); ++k)
    text += (k > 0 ? ", " : "") + names[k];
  return names.size() > most ? concat(text, " and ", names.size() - most, " more") : text;
}
} // namespace fresco
