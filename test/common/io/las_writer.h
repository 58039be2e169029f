// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>
/// Writes LAS files for tests: every version and point format. Shares no code with the reader.
namespace fresco::test::las {
struct Point {
  std::array<std::int32_t, 3> stored{};
  std::uint16_t intensity = 0;
  int return_number = 1, number_of_returns = 1, classification = 0;
  double time = 0;
  std::array<std::uint16_t, 3> color{};
};

struct File {
  int minor = 2, format = 0; ///< version 1.minor
  std::array<double, 3> scale{0.001, 0.001, 0.001}, offset{};
  std::vector<Point> points;
  int extra_bytes = 0; ///< per point
};

template <typename T>
void put(std::string& bytes, std::size_t at, T value)
{
  bytes.replace(at, sizeof(T), reinterpret_cast<const char*>(&value), sizeof(T));
}

inline std::string recordOf(const File& file, const Point& point)
{
  const bool modern = file.format >= 6;
  std::string bytes(modern ? 22 : 20, '\0');
  for (std::size_t axis = 0; axis < 3; ++axis)
    put(bytes, 4 * axis, point.stored[axis]);
  put(bytes, 12, point.intensity);
  const int shift = modern ? 4 : 3;
  put(bytes, 14, static_cast<std::uint8_t>(point.return_number | point.number_of_returns << shift));
  put(bytes, modern ? 16 : 15, static_cast<std::uint8_t>(point.classification));
  const auto append = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof(value)); };
  const int f = file.format;
  if (f != 0 && f != 2)
    append(point.time);
  if (f == 2 || f == 3 || f == 5 || f == 7 || f == 8 || f == 10)
    for (const std::uint16_t channel : point.color)
      append(channel);
  if (f == 8 || f == 10)
    append(std::uint16_t{77}); // near infrared
  if (f == 4 || f == 5 || f == 9 || f == 10)
    bytes.append(29, '\0'); // wave packet
  return bytes + std::string(static_cast<std::size_t>(file.extra_bytes), 'x');
}

inline std::string fileOf(const File& file)
{
  const std::size_t sizes[] = {227, 227, 227, 235, 375};
  std::string bytes(sizes[file.minor], '\0');
  bytes.replace(0, 4, "LASF");
  const std::size_t record = recordOf(file, {}).size();
  put(bytes, 24, std::uint8_t{1});
  put(bytes, 25, static_cast<std::uint8_t>(file.minor));
  put(bytes, 94, static_cast<std::uint16_t>(bytes.size()));
  put(bytes, 96, static_cast<std::uint32_t>(bytes.size() + 2)); // two bytes that LAS 1.0 has before its points
  put(bytes, 104, static_cast<std::uint8_t>(file.format));
  put(bytes, 105, static_cast<std::uint16_t>(record));
  if (file.minor == 4)
    put(bytes, 247, std::uint64_t{file.points.size()});
  else
    put(bytes, 107, static_cast<std::uint32_t>(file.points.size()));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    put(bytes, 131 + 8 * axis, file.scale[axis]);
    put(bytes, 155 + 8 * axis, file.offset[axis]);
  }
  bytes += "\xDD\xCC";
  for (const Point& point : file.points)
    bytes += recordOf(file, point);
  return bytes;
}
} // namespace fresco::test::las
