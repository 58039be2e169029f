// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "cameras/camera_refinement.h"
namespace fresco::texture {
/// Fills the cameras of the result and what is known of their accuracy: as given, or refined.
void placeCameras(const RefinementInput& input, const TextureOptions& options, const Progress& progress,
                  TextureResult& result);

/// Pose uncertainty factor, 0.2..1: how far what is seen close to an outline is to be distrusted. Small where the
/// photographs agree on the mesh to a fraction of a pixel, because then mesh and cameras are nearly exact; 1 where that
/// is not known.
double poseUncertainty(const TextureResult& result);

/// Whether the photographs are known to agree so well that texels may be made of several of them.
bool photographsAgree(const TextureResult& result);
} // namespace fresco::texture
