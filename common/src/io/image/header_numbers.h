// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <string_view>
namespace fresco::io {
/// Numbers of a file in either byte order; 0 beyond its end.
struct HeaderNumbers {
  std::string_view bytes;
  bool low_first = true;

  std::uint32_t number(std::size_t at, std::size_t length) const
  {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < length; ++i) {
      const std::size_t place = at + (low_first ? length - 1 - i : i);
      value = value << 8 | (place < bytes.size() ? static_cast<unsigned char>(bytes[place]) : 0U);
    }
    return value;
  }
};
} // namespace fresco::io
