// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
namespace fresco::io {
/// Notes that the file at `path` is an input.
void rememberInput(const std::string& path);

/// Whether rememberInput() was called for the file at `path`, under this or another name.
bool wasRead(const std::string& path);

/// Why the file at `path` is not to be opened for reading; "" if it is a regular file. To be asked first: opening a pipe
/// blocks for as long as nobody writes into it.
std::string reasonNotToOpen(const std::string& path);
} // namespace fresco::io
