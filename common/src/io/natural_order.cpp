// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cctype>
#include <fresco/io/natural_order.h>
#include <tuple>
namespace fresco {
namespace {
/// Digits become their count (without leading zeros) and themselves: longer numbers are larger.
std::string sortKey(const std::string& name)
{
  std::string key;
  for (std::size_t i = 0; i < name.size();) {
    if (!std::isdigit(static_cast<unsigned char>(name[i]))) {
      key += name[i++];
      continue;
    }
    const std::size_t end = std::min(name.find_first_not_of("0123456789", i), name.size());
    const std::size_t first = std::min(name.find_first_not_of('0', i), end);
    key += static_cast<char>('0' + std::min<std::size_t>(end - first, 70));
    key += name.substr(first, end - first);
    i = end;
  }
  return key;
}
} // namespace

bool isNaturallyBefore(const std::string& a, const std::string& b)
{
  return std::tuple(sortKey(a), a) < std::tuple(sortKey(b), b);
}
} // namespace fresco
