// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/progress.h>
#include <fresco/core/types.h>
#include <vector>
namespace fresco {
struct MixedPixelOptions {
  float angle = 20; ///< degrees, 0 < angle < 90: a surface joins two points if the way between leaves the beam at more
  float noise = 0;  ///< length, >= 0: deviation of the ranges; 0 = measured from the scan
  int k = 24;       ///< neighbouring beams, 8..64; the networks were trained with 24
  int threads = 0;  ///< 0 = all cores; the result does not depend on it
};

/// Removes mixed pixels (flying pixels, veil points): a laser beam that meets two surfaces at a depth jump returns a
/// range between theirs, a point in the air (Hebert & Krotkov 1992, "3D measurements from imaging laser radars").
/// Candidates have clearly nearer and clearly farther beams around them, and a surface could join them with at most
/// three quarters of the points next to them. Two networks, trained with scans of generated rooms, judge the candidates
/// (docs/mixed_pixels.md). A jump smaller than the spacing of the points over tan(angle) cannot be told from a slope.
/// @param viewpoints 3xN or 3x1; points of one viewpoint are judged among themselves, all stay if they are 12 or fewer
/// @return indices of the points that stay, ascending; finite ones only
/// @throws std::invalid_argument if sizes differ, a viewpoint is not finite or an option is out of range
/// @throws Cancelled
FRESCO_EXPORT std::vector<Index> withoutMixedPixels(const Points& points, const Points& viewpoints,
                                                    const MixedPixelOptions& options = {},
                                                    const Progress& progress = {});
} // namespace fresco
