// SPDX-License-Identifier: BSD-3-Clause
// Old names of <fresco/filters/core/mixed_pixels.h>, for one version.
#pragma once
#include <fresco/filters/core/mixed_pixels.h>
namespace fresco {
using VeilOptions [[deprecated("MixedPixelOptions")]] = MixedPixelOptions;
[[deprecated("withoutMixedPixels")]] inline std::vector<Index>
withoutVeil(const Points& points, const Points& viewpoints, const MixedPixelOptions& options = {})
{
  return withoutMixedPixels(points, viewpoints, options);
}
} // namespace fresco
