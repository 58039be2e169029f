// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
namespace fresco {
/// A point while a tree is built.
struct alignas(16) TreeItem {
  float x[3];
  int column;
};

/// Reorders such that no x[axis] before `middle` is larger than one from there on; mostly without branches, which
/// processors could not foretell.
FRESCO_EXPORT void selectMiddle(TreeItem* begin, TreeItem* middle, TreeItem* end, int axis);
} // namespace fresco
