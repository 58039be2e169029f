// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "cameras/surface_views.h"
#include <fresco/core/progress.h>
#include <fresco/core/similarity.h>
#include <fresco/registration/core/camera_alignment.h>
namespace fresco::registration {
/// A similarity after refinement, and by how much photographs show.
struct ViewedSimilarity {
  Similarity T_surface_cameras;
  Index patches = 0; ///< that tell it; 0 = too few, and nothing is changed
};

/// Refines the similarity by what photographs show: the scans are drawn as each camera would see them, patches of the
/// drawing are found in the photograph (Lucas & Kanade 1981, with gain and offset), and the seven numbers are chosen so
/// that the places of the patches project to where they were found.
ViewedSimilarity refineByViews(const CameraSet& set, const SurfacePainter& painter, const Similarity& T_surface_cameras,
                               const CameraAlignmentOptions& options, const Progress& progress);
} // namespace fresco::registration
