// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/texture/gltf_parts.h"
#include <string>
#include <string_view>
namespace fresco::io {
/// Puts triangles and vertices into the order that compresses best; the shape stays.
void orderForCompression(GltfPart& part);

/// A binary glTF whose vertices and indices are compressed by EXT_meshopt_compression, without loss.
/// @param glb of one buffer, each accessor with a view of its own
std::string compressedGlb(std::string_view glb);

/// Whether views of a binary glTF are compressed that way.
bool isCompressedGlb(std::string_view glb);

/// The same glTF with plain views in one buffer.
/// @throws std::runtime_error if it is damaged, or would be more than a thousand times as large
std::string uncompressedGlb(std::string_view glb);
} // namespace fresco::io
