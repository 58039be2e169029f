// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "charts/chart_raster.h"
#include "charts/patch_map.h"
#include "painting/atlas_paint.h"
#include <algorithm>
#include <cmath>
namespace fresco::texture {
/// A patch with its own texels, and where they lie in photographs; places are in texels from its first one.
class PatchFrame {
public:
  /// @param patch that has texels
  PatchFrame(const PaintScene& scene, Index patch)
      : chart(scene.chartOf(patch)), slot_(scene.slots[patch].number),
        first_(chart.texels.spans[chart.texels.begin[slot_]]),
        map(scene.patches, patch, patchTexels(scene.patches, chart, patch), {first_.x, first_.y})
  {}

  /// visit(place of the centre, x, y in the chart)
  template <typename Visit>
  void forTexels(const Visit& visit) const
  {
    chart.texels.forTexels(slot_, [&](int x, int y) { visit(place(x, y), x, y); });
  }

  /// visit(span in the chart)
  template <typename Visit>
  void forSpans(const Visit& visit) const
  {
    for (int s = chart.texels.begin[slot_]; s < chart.texels.begin[slot_ + 1]; ++s)
      visit(chart.texels.spans[s]);
  }

  /// visit(first, groups, pixels of their middles) for the texels of a span in their order: groups of `together` texels,
  /// the last one of what is left; up to four groups at a time, the first of which begins at that texel of the span.
  template <typename Visit>
  void forGroups(const TexelSpan& span, int together, const Visit& visit) const
  {
    const int groups = (span.length + together - 1) / together;
    const Eigen::Vector2f start = place(span.x, span.y);
    const PatchMap::Row row(map, start.y());
    constexpr simd::Float4 lanes = {0, 1, 2, 3};
    const float last = 0.5f * (span.length + (groups - 1) * together - 1); // middle of the last group, texels
    for (int first = 0; first < groups; first += 4) {
      simd::Float4 middle = (lanes + float(first)) * float(together) + 0.5f * (together - 1);
      middle = middle < last ? middle : simd::Float4{} + last;
      visit(first * together, std::min(4, groups - first), row.pixels(middle + start.x()));
    }
  }

  std::size_t texels() const ///< number
  {
    std::size_t sum = 0;
    forSpans([&](const TexelSpan& span) { sum += span.length; });
    return sum;
  }

  /// Of a texel's centre.
  Eigen::Vector2f place(int x, int y) const { return {x - first_.x + 0.5f, y - first_.y + 0.5f}; }

  /// The part of a span whose centres lie in the patch or at most `edge` (in weight of a corner) beyond.
  TexelSpan insideOf(const TexelSpan& span, float edge) const
  {
    const Eigen::Vector2f start = place(span.x, span.y);
    const Eigen::Vector3f at = map.weights(start.x(), start.y());
    const Eigen::Vector3f last = map.weights(start.x() + (span.length - 1), start.y());
    if (at.cwiseMin(last).minCoeff() >= -edge)
      return span;
    const Eigen::Vector3f step = map.weights(start.x() + 1, start.y()) - at;
    float low = 0, high = span.length - 1; // texels from the span's first
    for (int k = 0; k < 3; ++k) {
      const float least = -edge - at[k];
      if (step[k] > 1e-9f)
        low = std::max(low, std::ceil(least / step[k]));
      else if (step[k] < -1e-9f)
        high = std::min(high, std::floor(least / step[k]));
      else if (least > 0)
        high = -1;
    }
    TexelSpan out = span;
    out.length = 0;
    if (high >= low) {
      out.x += low;
      out.length = high - low + 1;
    }
    return out;
  }

  /// Weights of the corners, moved into the patch.
  Eigen::Vector3f inside(const Eigen::Vector2f& place) const
  {
    const Eigen::Vector3f weights = map.weights(place.x(), place.y()).cwiseMax(0.f);
    return weights / weights.sum();
  }

  const Chart& chart;

private:
  int slot_;
  TexelSpan first_;

public:
  PatchMap map;
};
} // namespace fresco::texture
