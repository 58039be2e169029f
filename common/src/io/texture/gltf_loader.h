// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
#include <string_view>
#include <tiny_gltf.h>
namespace fresco::io {
/// Binary glTF as tinygltf has it; images are not decoded.
/// @param folder that buffers and images outside of the file are read from
/// @throws std::runtime_error if malformed, nested too deep, with too many objects, or if it names files elsewhere
tinygltf::Model loadGltf(std::string_view content, const std::string& folder);
} // namespace fresco::io
