// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "photographs/photo_store.h"
#include <fresco/core/progress.h>
#include <fresco/search/ray_scene.h>
namespace fresco::texture {
/// What cameras are refined by.
struct RefinementInput {
  const TriangleMesh& mesh;
  const RayScene& scene;              ///< of the mesh
  const std::vector<ViewPart>& views; ///< those with equal camera models share one camera
  PhotoStore& photos;
};

/// Fills the cameras of the result and what is known of their accuracy: as given, or made to agree with each other on the
/// mesh. Bundle adjustment with the mesh as structure: alternates matching of photographs on the mesh with the adjustment
/// of poses and intrinsics; the search shrinks from round to round.
void placeCameras(const RefinementInput& input, const TextureOptions& options, const Progress& progress,
                  TextureResult& result);

/// Pose uncertainty factor, 0.2..1: how far what is seen close to an outline is to be distrusted. Small where the
/// photographs agree on the mesh to a fraction of a pixel, because then mesh and cameras are nearly exact; 1 where that
/// is not known.
double poseUncertainty(const TextureResult& result);

/// Octaves by which each view is to be trusted less, since it fits the others clearly worse than these fit each other; 0
/// where that is not known.
std::vector<double> misfits(const TextureResult& result);

/// Warns of the views that are trusted less by an octave or more.
void warnOfMisfits(const std::vector<ViewPart>& parts, TextureResult& result);

/// Pixels by which each view is off from the others, beyond what matching itself errs by; empty where that is not known.
std::vector<float> registrationErrors(const TextureResult& result);
} // namespace fresco::texture
