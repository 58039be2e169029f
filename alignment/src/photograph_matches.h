// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "surface_views.h"
#include <array>
#include <fresco/alignment/core/camera_alignment.h>
#include <fresco/core/progress.h>
namespace fresco::alignment {
/// A place on the surface that looks like a sparse point.
struct SurfaceMatch {
  Eigen::Vector3d place; ///< in ScanSurface's frame
  Index point = 0;       ///< of the sparse points
};

/// Grey values of a photograph.
cv::Mat1b grayOf(const Image& image);

/// Matches between views of the coloured scans and photographs of the sparse points, by SIFT (Lowe 2004).
std::vector<SurfaceMatch> matchPhotographs(const CameraSet& set, const SparsePoints& points,
                                           const SurfacePainter& painter, const ScanSurface& surface,
                                           const CameraAlignmentOptions& options, const Progress& progress);

/// A similarity that matches agree on.
struct MatchedSimilarity {
  Similarity T_surface_cameras;
  Index votes = 0; ///< cells of sparse points that agree
};

/// The best two similarities by random samples of three matches (RANSAC: Fischler & Bolles 1981); the second of what the
/// first does not explain.
/// @param scales smallest and largest @param tolerance in units of the cameras' frame
std::array<MatchedSimilarity, 2> agreeOnSimilarities(const std::vector<SurfaceMatch>& matches,
                                                     const SparsePoints& points,
                                                     const std::pair<double, double>& scales, double tolerance);
} // namespace fresco::alignment
