// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <fresco/core/point_set.h>
#include <fresco/core/progress.h>
#include <fresco/filters/core/normal_orientation.h>
#include <fresco/filters/core/oriented_normals.h>
#include <vector>
namespace fresco::model {
struct Job;

/// `set` without points that are not finite or have no normal; normals smoothed.
PointSet smoothed(const PointSet& set, const Job& job, const Progress& progress);

/// How normals of a cloud, whose scanner is not known, were brought to the free side.
enum class Orientation { viewpoints, file, cloud };

/// Normals of a cloud to the free side. Those of the file are used where neighbours agree on them and they stand on the
/// surface; a viewpoint per point comes first. Else new ones are turned by orientToFreeSide().
/// @param set      cloud in one frame; gets normals and confidences
Orientation orientCloud(PointSet& set, const FreeSideHints& hints, const NormalOptions& options);

/// Share of neighbouring normals that point to the same side, less than 0.97 where they are not consistent; 0 where they do not
/// stand on the surface.
double consistency(const Points& points, const Points& normals, int threads);

/// Distance between neighbouring points on the surface, median. @throws std::runtime_error for fewer than 10 finite points
double pointSpacing(const Points& points, int threads);
} // namespace fresco::model
