// SPDX-License-Identifier: BSD-3-Clause
#include "charts/texel_spans.h"
#include "photographs/grid.h"
#include <algorithm>
namespace fresco::texture {
OwnedTexels OwnedTexels::from(const std::vector<int>& owner, int width)
{
  struct Run {
    int patch;
    TexelSpan span;
  };
  std::vector<Run> runs;
  const int height = width > 0 ? owner.size() / width : 0;
  for (int y = 0; y < height; ++y) {
    const int* row = owner.data() + cellAt(0, y, width);
    for (int x = 0, end = 0; x < width; x = end) {
      for (end = x + 1; end < width && row[end] == row[x]; ++end)
        ;
      if (row[x] >= 0)
        runs.push_back(
            {row[x],
             {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), static_cast<std::uint16_t>(end - x)}});
    }
  }
  std::stable_sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.patch < b.patch; });
  OwnedTexels out;
  out.spans.reserve(runs.size());
  for (const Run& run : runs) {
    if (out.patches.empty() || out.patches.back() != run.patch) {
      out.patches.push_back(run.patch);
      out.begin.push_back(out.spans.size());
    }
    out.spans.push_back(run.span);
  }
  out.begin.push_back(out.spans.size());
  return out;
}

std::size_t OwnedTexels::count() const
{
  std::size_t sum = 0;
  for (const TexelSpan& span : spans)
    sum += span.length;
  return sum;
}
} // namespace fresco::texture
