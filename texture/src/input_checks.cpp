// SPDX-License-Identifier: BSD-3-Clause
#include "input_checks.h"
#include "views/exif.h"
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/poses.h>
#include <fresco/core/require.h>
namespace fresco::texture {
namespace {
void validateView(const TextureView& view, std::size_t index)
{
  const std::string name = view.path.empty() ? concat("view ", index) : view.path;
  const CameraModel& c = view.camera;
  require(c.width >= 3 && c.height >= 3 && c.width <= 65535 && c.height <= 65535, "texture: ", name, ": camera of ",
          c.width, "x", c.height, " pixels");
  try {
    validateCamera(c);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(concat("texture: ", name, ": ", error.what()));
  }
  const Eigen::Matrix3d R = view.T_camera_world.linear();
  require(view.T_camera_world.matrix().allFinite() && isInReach(view.T_camera_world.translation()) &&
              (R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-3 && R.determinant() > 0,
          "texture: ", name, ": the pose is not finite or no rigid motion");
  require(!view.image.empty() || !view.path.empty(), "texture: ", name, ": neither an image nor a path");
}

void warnOfRotations(const std::vector<TextureView>& views, TextureResult& result)
{
  std::string first;
  Index count = 0;
  for (const TextureView& view : views)
    if (view.image.empty() && exifOrientation(view.path) != 1 && count++ == 0)
      first = view.path;
  if (count > 0)
    result.warnings.push_back(
        concat(first, count > 1 ? concat(" and ", count - 1, " more carry") : " carries",
               " an EXIF rotation, which is ignored: cameras belong to pixels as they are stored"));
}
} // namespace

void validate(const TriangleMesh& mesh, const std::vector<TextureView>& views, const TextureOptions& options)
{
  validateMesh(mesh);
  require(mesh.faceCount() > 0 && surfaceArea(mesh) > 0, "texture: the mesh has no face of positive area");
  require(mesh.vertexCount() < (1 << 29) && mesh.faceCount() < (1 << 29), "texture: the mesh is too large");
  require(options.texel >= 0 && std::isfinite(options.texel), "texture: texel ", options.texel,
          " is negative or not finite");
  require(options.atlas == 0 || (options.atlas >= 128 && options.atlas <= 16384), "texture: atlas ", options.atlas,
          " is neither 0 nor in 128..16384");
  require(options.border >= 1 && options.border <= 16, "texture: border ", options.border, " is not in 1..16");
  require(options.smoothness >= 0 && std::isfinite(options.smoothness), "texture: smoothness ", options.smoothness,
          " is negative or not finite");
  require(options.margin >= 0 && options.margin <= 100, "texture: margin ", options.margin, " is not in 0..100");
  require(options.depth_tolerance >= 0 && options.depth_tolerance <= 0.5, "texture: depth tolerance ",
          options.depth_tolerance, " is not in 0..0.5");
  require(options.blend_width >= 0 && options.blend_width <= 100, "texture: blend width ", options.blend_width,
          " is not in 0..100");
  require(options.rounds >= 0 && options.rounds <= 100, "texture: rounds ", options.rounds, " is not in 0..100");
  require(options.memory >= 1, "texture: memory ", options.memory, " MB is below 1");
  for (std::size_t v = 0; v < views.size(); ++v)
    validateView(views[v], v);
}

void checkPhotos(PhotoStore& photos, const std::vector<TextureView>& views, int threads, TextureResult& result)
{
  parallelFor(
      views.size(), threads, [&](Index v) { photos.get(v); }, 1);
  warnOfRotations(views, result);
}
} // namespace fresco::texture
