// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <fresco/core/types.h>
namespace fresco::texture {
/// Number of cells of a grid; 64 bits, so that large images do not overflow.
inline std::size_t cellCount(Index width, Index height) { return width * height; }

/// Number of a cell, counted row by row from the top.
inline std::size_t cellAt(Index x, Index y, Index width) { return y * width + x; }
} // namespace fresco::texture
