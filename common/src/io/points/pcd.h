// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/point_table.h>
#include <string>
#include <string_view>
namespace fresco::io {
/// PCD 0.5 to 0.7: ascii, binary, binary_compressed. Padding columns "_" are left out.
/// @throws std::runtime_error if malformed, truncated or without points
PointTable parsePcd(std::string_view content);

/// What PCD calls a type: 'F', 'I' or 'U'.
inline char typeLetter(Scalar type)
{
  return visitScalar(type, [](auto zero) {
    using T = decltype(zero);
    return std::is_floating_point_v<T> ? 'F' : std::is_signed_v<T> ? 'I' : 'U';
  });
}

/// PCD 0.7, binary or binary_compressed. VIEWPOINT is written where the table has a sensor pose.
void writePcd(const std::string& path, const PointTable& table, bool compressed);
} // namespace fresco::io
