// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
namespace fresco::io {
/// Whether readFile() has read the file at `path`, under this or another name.
bool wasRead(const std::string& path);
} // namespace fresco::io
