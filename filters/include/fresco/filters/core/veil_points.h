// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/types.h>
#include <vector>
namespace fresco {
struct VeilOptions {
  float angle =
      20; ///< degrees, 0 < angle < 90: between a beam and the way to a neighbouring point; below, no surface joins them
  float noise = 0; ///< length, >= 0: deviation of the ranges; 0 = measured from the scan
  int k = 24;      ///< neighbouring beams, 8..64; the networks were trained with 24
  int threads = 0; ///< 0 = all cores; the result does not depend on it
};

/// Veil points: a laser beam that meets two surfaces at a depth jump returns a range between theirs, a point in the
/// air. Such a point has beams around it that are clearly nearer and others that are clearly farther, and a surface
/// could join it with three quarters of those next to it at most (the way to the others leaves the beam at less than
/// `angle`). Whether one of these points lies in the air is judged by networks that were trained with scans of
/// generated rooms (docs/filters.md): from the ranges around it, from where the surfaces on its sides, continued as
/// planes, pass it, and in a second look from what its neighbours were taken for and how wide the veil of the scan is.
/// Silhouettes, thin legs and edges stay. A jump smaller than the distance of neighbouring points over tan(angle)
/// cannot be told from a slope; the denser the scan, the smaller the jumps that are found. Beams less than 2 mrad apart
/// overlap: there beams 3 mrad apart are looked at too.
/// @param viewpoints 3xN or 3x1; points of one viewpoint are judged among themselves, all stay if they are 12 or fewer
/// @return indices of the points that stay, ascending; finite ones only
/// @throws std::invalid_argument if sizes differ, a viewpoint is not finite or an option is out of range
FRESCO_EXPORT std::vector<Index> withoutVeil(const Points& points, const Points& viewpoints,
                                             const VeilOptions& options = {});
} // namespace fresco
