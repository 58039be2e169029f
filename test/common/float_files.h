// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>
#include <zlib.h>
/// Bytes of files of floats, as other programs write them; rows from the top.
namespace fresco::test {
struct Floats {
  int width = 0, height = 0;
  std::vector<float> values;
};

inline std::string bytesOf(float value, bool low_first = true)
{
  std::string bytes(4, '\0');
  std::memcpy(bytes.data(), &value, 4);
  if (!low_first)
    std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

inline std::string pfmBytes(const Floats& image, bool low_first = true)
{
  std::string text = "Pf\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n" +
                     (low_first ? "-1.0\n" : "1.0\n");
  for (int y = image.height - 1; y >= 0; --y)
    for (int x = 0; x < image.width; ++x)
      text += bytesOf(image.values[std::size_t(y) * image.width + x], low_first);
  return text;
}

inline std::string npyBytes(const Floats& image, bool wide = false)
{
  std::string head = std::string("{'descr': '") + (wide ? "<f8" : "<f4") + "', 'fortran_order': False, 'shape': (" +
                     std::to_string(image.height) + ", " + std::to_string(image.width) + "), }";
  head.resize((head.size() + 10 + 64) / 64 * 64 - 11, ' ');
  head += '\n';
  std::string text = std::string("\x93NUMPY\x01\x00", 8) + char(head.size()) + char(head.size() >> 8) + head;
  for (const float value : image.values) {
    const double as_double = value;
    text.append(wide ? reinterpret_cast<const char*>(&as_double) : reinterpret_cast<const char*>(&value), wide ? 8 : 4);
  }
  return text;
}

/// One strip, not compressed; or by Deflate, with the prediction of floats.
inline std::string tiffBytes(const Floats& image, bool low_first = true, bool predicted = false)
{
  const auto number = [&](std::uint32_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i)
      text += static_cast<char>(value >> 8 * (low_first ? i : bytes - 1 - i));
    return text;
  };
  std::string data;
  for (int y = 0; y < image.height; ++y) {
    std::string row;
    for (int x = 0; x < image.width; ++x)
      row += bytesOf(image.values[std::size_t(y) * image.width + x], predicted ? false : low_first);
    if (predicted) {
      std::string planes;
      for (int k = 0; k < 4; ++k)
        for (int x = 0; x < image.width; ++x)
          planes += row[4 * std::size_t(x) + k];
      for (std::size_t i = planes.size() - 1; i > 0; --i)
        planes[i] = static_cast<char>(planes[i] - planes[i - 1]);
      row = planes;
    }
    data += row;
  }
  if (predicted) {
    std::string packed(compressBound(data.size()), '\0');
    uLongf size = packed.size();
    compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(data.data()), data.size());
    data = packed.substr(0, size);
  }
  const std::vector<std::pair<int, std::uint32_t>> entries = {
      {256, image.width}, {257, image.height}, {258, 32},          {259, predicted ? 8 : 1}, {262, 1}, {273, 8},
      {277, 1},           {278, image.height}, {279, data.size()}, {317, predicted ? 3 : 1}, {339, 3}};
  std::string table = number(entries.size(), 2);
  for (const auto& [tag, value] : entries)
    table += number(tag, 2) + number(4, 2) + number(1, 4) + number(value, 4);
  return (low_first ? "II" : "MM") + number(42, 2) + number(8 + data.size(), 4) + data + table + number(0, 4);
}
} // namespace fresco::test
