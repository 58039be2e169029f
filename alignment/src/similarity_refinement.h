// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan_surface.h"
#include "sparse_model.h"
namespace fresco::alignment {
/// How a similarity is refined; lengths in the model's unit.
struct RefinementRange {
  double start = 0;  ///< distance from the surface below which points count at first
  double end = 0;    ///< and in the end
  bool flat = false; ///< whether planes count less where the surface bends: averaged points lie beside it there
};

/// Moves, turns and scales the model so that its points lie on the surface: point-to-plane (Chen & Medioni 1992) with a
/// scale, Tukey's biweight. @param points columns of SparseModel::points
Similarity refineSimilarity(const SparseModel& model, const std::vector<Index>& points, const ScanSurface& surface,
                            const RefinementRange& range, const Similarity& T_surface_model);

/// Deviation of the points from the surface in the model's unit, of those that are closer than a range of three times that.
double noiseOf(const SparseModel& model, const ScanSurface& surface, const Similarity& T_surface_model, double range);

/// A place of the model, judged by all its points.
struct PlaceCheck {
  double support = 0; ///< share of points on the surface and in sight, 0..1
  double blocked = 0; ///< share of points behind a surface, 0..1
  double rms = 0;     ///< of the supported points, model's unit
  double colors = 0;  ///< correlation of the colours of supported points with those of the surface, -1..1; 0 = none
};

/// @param tolerance of the distance from the surface, model's unit
PlaceCheck checkPlace(const SparseModel& model, const ScanSurface& surface, const Similarity& T_surface_model,
                      double tolerance);
} // namespace fresco::alignment
