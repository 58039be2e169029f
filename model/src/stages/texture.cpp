// SPDX-License-Identifier: BSD-3-Clause
#include "stages/stages.h"
#include <fresco/core/require.h>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/pose_file.h>
#include <fresco/texture/core/texture_reconstruction.h>
namespace fresco::model {
namespace {
/// @param poses of the frames of an RGB-D folder, world from camera
std::vector<TextureView> viewsOf(const ModelInput& input, const std::vector<Pose>& poses)
{
  std::vector<TextureView> views;
  for (const View& view : input.cameras.views) {
    TextureView next;
    next.camera = input.cameras.cameras[view.camera];
    next.T_camera_world = view.T_camera_world;
    next.path = input.images + "/" + view.image;
    views.push_back(std::move(next));
  }
  if (input.rgbd)
    for (std::size_t f = 0; f < input.rgbd->frames.size(); ++f) {
      TextureView next;
      next.camera = input.rgbd->camera;
      next.T_camera_world = Eigen::Isometry3d(*poses.at(f)).inverse();
      next.path = input.rgbd->frames[f].color;
      views.push_back(std::move(next));
    }
  return views;
}
} // namespace

Figures makeTexture(const Job& job, const Progress& progress)
{
  const auto& [input, files, options] = job;
  const TriangleMesh mesh = readMesh(files.mesh);
  TextureOptions texture;
  texture.texel = options.texel;
  texture.threads = options.threads;
  const std::vector<TextureView> views = viewsOf(input, readPoses(files.poses));
  const TextureResult result = reconstructTexture(mesh, views, texture, progress);
  for (std::size_t i = 0; i < result.masks.size(); ++i)
    writeImage(files.mask(i, result.masks.size()), result.masks[i]);
  writeTexturedMesh(files.model_glb, result.model);
  writeTexturedMesh(files.model_obj, result.model);
  writeTexturedMesh(files.viewer_glb, result.model, 90); // smaller, since the report has it inside
  Figures phases;
  for (const auto& [phase, seconds] : result.seconds)
    phases[phase] = seconds;
  return {{"photographs", views.size()},
          {"photographs_used", result.views_used},
          {"coverage", result.coverage},
          {"cameras", result.refined ? "refined" : "left as given"},
          {"disagreement_before_pixels", result.disagreement_before},
          {"disagreement_after_pixels", result.disagreement_after},
          {"charts", result.charts},
          {"atlases", result.model.atlases.size()},
          {"atlas_width", result.model.atlases.empty() ? 0 : result.model.atlases[0].width},
          {"atlas_used", result.used},
          {"texel", result.texel},
          {"warnings", result.warnings},
          {"seconds", phases}};
}
} // namespace fresco::model
