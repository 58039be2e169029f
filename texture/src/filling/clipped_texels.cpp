// SPDX-License-Identifier: BSD-3-Clause
#include "filling/clipped_texels.h"
#include "filling/color_diffusion.h"
#include "painting/patch_frame.h"
#include <algorithm>
#include <fresco/core/parallel.h>
namespace fresco::texture {
namespace {
/// @param colors 3x3, of the patch's corners
void continuePatch(const PaintScene& scene, Index patch, const Projector& view, const Image& photo,
                   const Eigen::Matrix3f& colors, std::vector<Image>& atlases)
{
  PatchFrame frame(scene, patch);
  if (!frame.map.look(view))
    return;
  frame.forTexels([&](const Eigen::Vector2f& center, int x, int y) {
    const Eigen::Vector3f inside = frame.inside(center);
    const Eigen::Vector2f at = frame.map.place(inside), shown = frame.map.pixel(at.x(), at.y());
    const Eigen::Vector3f clipped = samplePhotoQuickly(photo, shown.x(), shown.y()).unaryExpr(&clippedShare);
    const Eigen::Vector3f around = (colors * inside).cwiseMax(1.f), known = around - clipped.cwiseProduct(around);
    std::uint8_t* pixel = atlases[frame.chart.atlas].pixel(frame.chart.x + x, frame.chart.y + y);
    const Eigen::Vector3f painted(pixel[0], pixel[1], pixel[2]);
    const float all = clipped.minCoeff() * around.squaredNorm(); // where no channel tells
    const float light =
        (known.dot(painted) + all * lightAbove(around, painted)) / (known.dot(around) + all); // least squares
    for (int c = 0; c < 3; ++c)
      pixel[c] += clipped[c] * std::max(0.f, std::min(light * around[c], 255.f) - pixel[c]) + 0.5f;
  });
}
} // namespace

std::vector<char> clippedPatches(const PaintScene& scene, const Candidates& candidates)
{
  std::vector<char> out(scene.patches.size());
  for (Index i = 0; i < scene.patches.size(); ++i)
    if (const Candidate* at = scene.isSeen(i) ? candidates.find(i, scene.view[i]) : nullptr)
      out[i] = at->clipped || clippedShare(*std::max_element(at->color.begin(), at->color.end())) > 0.5f;
  return out;
}

void continueClipped(const PaintScene& scene, const PaintSources& sources, const std::vector<char>& clipped,
                     const Points& colors, std::vector<Image>& atlases)
{
  std::vector<std::vector<Index>> by_view(sources.views.size());
  for (Index i = 0; i < scene.patches.size(); ++i)
    if (clipped[i])
      by_view[scene.view[i]].push_back(i);
  forViews(by_view, sources.photos, [&](int v, const Image& photo, const std::vector<Index>& patches) {
    parallelFor(patches.size(), scene.threads, [&](Index k) {
      continuePatch(scene, patches[k], sources.views[v], photo, colors.middleCols<3>(3 * patches[k]), atlases);
    });
  });
}
} // namespace fresco::texture
