// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/image.h>
#include <fresco/core/point_set.h>
#include <fresco/core/progress.h>
#include <fresco/core/similarity.h>
#include <functional>
namespace fresco {
/// Brings cameras with sparse points, of a frame and scale of their own, into the frame of scans: docs/camera_alignment.md.
struct CameraAlignmentOptions {
  /// Least share of the sparse points that lie on the surface of the scans, in sight of their cameras, 0..1.
  double min_support = 0.25;
  /// Most that a second, distinct place may reach of the score of the best, 0..1: above, the place is ambiguous. Rooms
  /// with some furniture come to 0.85 turned by half a turn, bare ones and wrong rooms to 0.96 and more.
  double max_alias = 0.9;
  /// Reads the photograph of a view, called from many threads at once. With it, photographs are matched with views of the
  /// scans that have colours or intensities; empty = shape alone tells.
  std::function<Image(Index view)> photograph;
  int threads = 0; ///< 0 = all cores; the result does not depend on it
};

struct CameraAlignmentResult {
  Similarity T_scans_cameras;
  bool already_aligned = false; ///< the cameras stand in the scans' frame; the similarity is the identity
  Index matches = 0;            ///< between photographs and scans that agree on the place; 0 = shape alone told it
  double support = 0;           ///< share of the sparse points on the surface and in sight of their cameras, 0..1
  double blocked = 0;           ///< share of the sparse points behind a surface, seen from their cameras, 0..1
  double alias = 0; ///< score of the next best, distinct place, of that of the best, or of matches; 0 if there is none
  double rms = 0;   ///< distance of the supported points from the surface, unit of the scans
};

/// Fewer sparse points are refused: a similarity found by them would have hardly any redundancy.
constexpr Index fewest_sparse_points = 50;

/// @param set     views of `points`
/// @param surface points of the scans or of a mesh; colours tell places of one shape apart
/// @throws std::invalid_argument if an option is out of range, a point or pose is not finite or a track names no view
/// @throws std::runtime_error if there are too few points, no place is supported, or several are: the message says which
/// @throws Cancelled
FRESCO_EXPORT CameraAlignmentResult alignCameras(const CameraSet& set, const SparsePoints& points,
                                                 const PointSet& surface, const CameraAlignmentOptions& options = {},
                                                 const Progress& progress = {});
} // namespace fresco
