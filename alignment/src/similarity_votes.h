// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan_surface.h"
#include "sparse_model.h"
#include <fresco/core/progress.h>
namespace fresco::alignment {
/// A place of the model that many of its points vote for.
struct VotedSimilarity {
  Similarity T_surface_model;
  int votes = 0;
};

/// Scales and shifts for one rotation each, by votes: generalised Hough transform (Ballard 1981). Every point of the model
/// votes for the shifts that bring it into a cell of the surface with a normal like its own.
/// @param scales range of the model's unit in units of the surface
std::vector<VotedSimilarity> voteForSimilarities(const SparseModel& model, const ScanSurface& surface,
                                                 const std::vector<Eigen::Matrix3d>& rotations,
                                                 const std::pair<double, double>& scales, int threads,
                                                 const Progress& progress);
} // namespace fresco::alignment
