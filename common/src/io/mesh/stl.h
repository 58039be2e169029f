// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/mesh.h>
#include <string>
#include <string_view>
namespace fresco::io {
/// STL, ASCII or binary: a file without zero bytes that begins with "solid" is ASCII. Equal corners become one vertex;
/// triangles with two equal corners are left out.
/// @throws std::runtime_error if malformed, truncated or without a triangle, or if a coordinate is not finite
TriangleMesh parseStl(std::string_view content);

/// Binary STL: coordinates as float, in which large ones lose digits, no attributes.
/// @throws std::runtime_error also if there is no face or too many of them
void writeStl(const std::string& path, const TriangleMesh& mesh);
} // namespace fresco::io
