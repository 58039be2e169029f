// SPDX-License-Identifier: BSD-3-Clause
#pragma once
namespace fresco::search {
/// A point while a tree is built.
struct alignas(16) TreeItem {
  float x[3];
  int column;
};

/// Reorders such that no x[axis] before `middle` is larger than one from there on; mostly without branches, which
/// processors could not foretell.
void selectMiddle(TreeItem* begin, TreeItem* middle, TreeItem* end, int axis);
} // namespace fresco::search
