// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/common/types.h>
#include <vector>
namespace fresco {
struct VeilOptions {
  float angle =
      20; ///< degrees, 0 < angle < 90: between a beam and the way to a neighbouring point; below, no surface joins them
  float noise = 0; ///< length, >= 0: deviation of the ranges; 0 = measured from the scan
  int k = 24;      ///< neighbouring beams, 8..64
  int threads = 0; ///< 0 = all cores; the result does not depend on it
};

/// Veil points: a laser beam that meets two surfaces at a depth jump returns a range between theirs, a point in the
/// air. Such a point has beams around it that are clearly nearer and others that are clearly farther, a surface could
/// join it with half of them at most (the way to the others leaves the beam at less than `angle`), and its nearest
/// neighbour in space is farther than its nearest beam. The surfaces on its sides, continued as planes, pass in front
/// of it and behind it, or none of them meets it; more sides have to if it has a neighbour nearby. Points of a
/// silhouette have nobody in front, points beside it nobody behind, thin legs have neighbours along themselves, and
/// edges continue the surface of one side: all of these stay. A jump smaller than the distance of neighbouring points
/// over tan(angle) cannot be told from a slope; the denser the scan, the smaller the jumps that are found, down to
/// beams 3 mrad apart: nearer ones overlap, and are left out of the beams around.
/// @param viewpoints 3xN or 3x1; points of one viewpoint are judged among themselves, all stay if they are 12 or fewer
/// @return indices of the points that stay, ascending; finite ones only
/// @throws std::invalid_argument if sizes differ, a viewpoint is not finite or an option is out of range
std::vector<Index> withoutVeil(const Points& points, const Points& viewpoints, const VeilOptions& options = {});
} // namespace fresco
