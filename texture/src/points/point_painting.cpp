// SPDX-License-Identifier: BSD-3-Clause
#include "points/point_painting.h"
#include "painting/outline_texels.h"
#include "painting/patch_frame.h"
#include "views/visible_surface.h"
#include <algorithm>
#include <fresco/core/parallel.h>
namespace fresco::texture {
namespace {
/// Samples that count anywhere on a patch.
void gatherAround(const PatchMesh& patches, Index patch, const SurfaceGaussian& gaussian, std::vector<int>& found)
{
  const Eigen::Vector3f middle = patches.middle(patch);
  gaussian.gather(middle, (patches.corners(patch).colwise() - middle).colwise().norm().maxCoeff(), found);
}

/// @return texels without samples
std::vector<PatchTexel> paintPatch(const PaintScene& scene, const PointPaint& paint, Index patch, Image& atlas)
{
  std::vector<int> found;
  gatherAround(scene.patches, patch, paint.gaussian, found);
  const Eigen::Matrix3f corners = scene.patches.corners(patch);
  const Eigen::Vector3f normal = scene.patches.normals.col(patch);
  const PatchFrame frame(scene, patch);
  std::vector<PatchTexel> unknown;
  frame.forTexels([&](const Eigen::Vector2f& center, int x, int y) {
    Eigen::Vector4f sum =
        paint.gaussian.at(corners * frame.map.weights(center.x(), center.y()), normal, found, paint.values);
    if (!(sum.w() > 0)) // a texel of the border may lie in the air
      sum = paint.gaussian.at(corners * frame.inside(center), normal, found, paint.values);
    if (!(sum.w() > 0))
      return unknown.push_back({int(patch), x, y});
    std::uint8_t* pixel = atlas.pixel(frame.chart.x + x, frame.chart.y + y);
    for (int c = 0; c < 3; ++c)
      pixel[c] = std::clamp(sum[c] / sum.w(), 0.f, 255.f) + 0.5f;
  });
  return unknown;
}
} // namespace

Eigen::VectorXf patchDensities(const PatchMesh& patches, const SurfaceSamples& samples, const SurfaceGaussian& gaussian,
                               int threads)
{
  const Points spacing = samples.spacing.transpose().replicate<3, 1>();
  Eigen::VectorXf out(patches.size());
  parallelFor(patches.size(), threads, [&](Index i) {
    std::vector<int> found;
    gatherAround(patches, i, gaussian, found);
    const Eigen::Matrix3f corners = patches.corners(i);
    Eigen::Vector4f sum = Eigen::Vector4f::Zero();
    for (const Eigen::Vector3f& place : {Eigen::Vector3f(patches.middle(i)), Eigen::Vector3f(corners.col(0)),
                                         Eigen::Vector3f(corners.col(1)), Eigen::Vector3f(corners.col(2))})
      sum += gaussian.at(place, patches.normals.col(i), found, spacing);
    out[i] = sum.w() > 0 ? sum.w() / sum[0] : 0.f;
  });
  return out;
}

Points sharpened(const SurfaceSamples& samples, const SurfaceGaussian& gaussian, const Points& values,
                 const PointTextureOptions& options)
{
  Points current = values, next = values;
  for (int round = 0; round < options.rounds; ++round) {
    parallelRanges(samples.size(), options.threads, [&](Index begin, Index end) {
      std::vector<int> found;
      for (Index i = begin; i < end; ++i) {
        gaussian.gather(samples.places.col(i), 0, found);
        const Eigen::Vector4f sum = gaussian.at(samples.places.col(i), samples.normals.col(i), found, current);
        next.col(i) = current.col(i) + values.col(i) - sum.head<3>() / sum.w(); // itself is among them
      }
    });
    current.swap(next);
  }
  return current;
}

void paintSamples(const PaintScene& scene, const PointPaint& paint, Eigen::VectorXi& view, Index own,
                  TextureResult& result)
{
  std::vector<std::vector<PatchTexel>> unknown(scene.patches.size());
  parallelFor(scene.patches.size(), scene.threads, [&](Index i) {
    if (scene.isSeen(i))
      unknown[i] = paintPatch(scene, paint, i, result.model.atlases[scene.chartOf(i).atlas]);
  });
  std::vector<PatchTexel> all;
  for (Index i = 0; i < scene.patches.size(); ++i) {
    if (!unknown[i].empty() && unknown[i].size() == PatchFrame(scene, i).texels())
      view[i] = -1;
    else
      all.insert(all.end(), unknown[i].begin(), unknown[i].end());
  }
  describeViews(scene.patches, view.head(own), result);
  fillUnknown(scene, all, result.model.atlases, result.masks);
}
} // namespace fresco::texture
