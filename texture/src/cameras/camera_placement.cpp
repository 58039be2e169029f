// SPDX-License-Identifier: BSD-3-Clause
#include "cameras/camera_placement.h"
#include <algorithm>
#include <fresco/core/require.h>
namespace fresco::texture {
void placeCameras(const RefinementInput& input, const TextureOptions& options, const Progress& progress,
                  TextureResult& result)
{
  const std::vector<TextureView>& views = input.views;
  for (const TextureView& view : views)
    result.cameras.push_back({view.camera, view.T_camera_world});
  constexpr std::size_t most_views = 400; // the normal equations are solved densely
  if (options.refine && views.size() > most_views)
    result.warnings.push_back(concat("cameras are taken as given: ", views.size(), " views are more than the ",
                                     most_views, " that are refined"));
  if (!options.refine || views.size() < 2 || views.size() > most_views)
    return;
  const RefinedCameras refined = refineCameras(input, options.threads, progress);
  result.refined = refined.changed;
  result.disagreement_before = refined.before;
  result.disagreement_after = refined.changed ? refined.after : refined.before;
  for (std::size_t v = 0; v < views.size() && refined.changed; ++v)
    result.cameras[v] = {refined.cameras[v], refined.T_camera_world[v]};
}

double poseUncertainty(const TextureResult& result)
{
  constexpr double exact = 0.3, vague = 0.7; // pixels: what matching itself errs by, and a disagreement that shows
  constexpr double least = 0.2;              // the mesh itself stays uncertain
  const double uncertainty = (result.disagreement_after - exact) / (vague - exact);
  return result.disagreement_before > 0 ? std::clamp(uncertainty, least, 1.0) : 1.0;
}

bool photographsAgree(const TextureResult& result)
{
  return result.disagreement_before > 0 && result.disagreement_after <= agreement_pixels;
}
} // namespace fresco::texture
