// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <vector>
namespace fresco::texture {
/// Texels x .. x + length - 1 of a row, all of one patch.
struct TexelSpan {
  std::uint16_t x, y, length;
};

/// Which texels of a chart get their colour from which patch.
struct OwnedTexels {
  std::vector<int> patches;     ///< ascending, those with texels
  std::vector<int> begin;       ///< patches.size() + 1, into `spans`
  std::vector<TexelSpan> spans; ///< of each patch row by row

  /// @param owner rows from the top: patch of each texel, -1 = none
  static OwnedTexels from(const std::vector<int>& owner, int width);

  std::size_t count() const; ///< texels
  /// visit(x, y) for each texel of the patch with that number in `patches`, row by row
  template <typename Visit>
  void forTexels(int slot, const Visit& visit) const
  {
    for (int s = begin[slot]; s < begin[slot + 1]; ++s)
      for (int x = spans[s].x; x < spans[s].x + spans[s].length; ++x)
        visit(x, static_cast<int>(spans[s].y));
  }
};
} // namespace fresco::texture
