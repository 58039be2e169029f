// SPDX-License-Identifier: BSD-3-Clause
#include "painting/atlas_paint.h"
#include "painting/patch_frame.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
namespace fresco::texture {
namespace {
/// A view at work: only its own photograph is held.
struct PaintedView {
  const PaintSources& sources;
  const Image& photo;
  PixelGain gain;
};

/// Colours of a patch's texels in one photograph.
class PatchSampler {
public:
  /// @param map that looks at the photograph
  PatchSampler(const PaintScene& scene, const PatchMap& map, const PaintedView& view, Index patch)
      : map_(map), photo_(view.photo), gain_(view.gain)
  {
    for (int k = 0; k < 3; ++k)
      least_[k] = goesOn(scene, patch, (k + 1) % 3) ? -HUGE_VALF : inset(k);
    constexpr float most = 16; // samples each way: enough for any mean
    const float pixels_per_texel = map.middleSteps().colwise().norm().maxCoeff();
    steps_ = std::isfinite(pixels_per_texel) ? std::lround(std::clamp(pixels_per_texel, 1.f, most)) : 1;
  }

  /// Mean over the texel, corrected.
  Eigen::Vector3f operator()(const Eigen::Vector2f& center) const
  {
    const Eigen::Vector2f middle = pixel(center);
    if (steps_ == 1)
      return gain_(middle, samplePhoto(photo_, middle.x(), middle.y()));
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    const float step = 1.f / steps_;
    for (int j = 0; j < steps_; ++j)
      for (int i = 0; i < steps_; ++i) {
        const Eigen::Vector2f p = pixel(center + Eigen::Vector2f((i + 0.5f) * step - 0.5f, (j + 0.5f) * step - 0.5f));
        sum += samplePhoto(photo_, p.x(), p.y());
      }
    return gain_(middle, sum * (step * step));
  }

private:
  /// Weight of corner k at edge_pixels from the side opposite of it: nearer to an edge, pixels mix with what is beyond.
  float inset(int k) const
  {
    constexpr float edge_pixels = 0.75f, most = 0.2f; // a patch of few pixels keeps its middle
    const Eigen::Matrix<float, 2, 3> c = map_.cornerPixels();
    const Eigen::Vector2f side = c.col((k + 2) % 3) - c.col((k + 1) % 3), to = c.col(k) - c.col((k + 1) % 3);
    const float height = std::abs(side.x() * to.y() - side.y() * to.x()) / std::max(side.norm(), 1e-6f);
    return std::min(most, edge_pixels / std::max(height, 1e-6f));
  }

  Eigen::Vector2f pixel(const Eigen::Vector2f& texel) const
  {
    const Eigen::Vector3f weights = map_.weights(texel.x(), texel.y());
    if (!(weights.array() < least_.array()).any())
      return map_.pixel(texel.x(), texel.y());
    const Eigen::Vector3f inside = weights.cwiseMax(least_); // what lies beyond may be another surface
    const Eigen::Vector2f at = map_.place(inside / inside.sum());
    return map_.pixel(at.x(), at.y());
  }

  const PatchMap& map_;
  const Image& photo_;
  const PixelGain& gain_;
  Eigen::Vector3f least_; ///< of the corners' weights: below 0 where the surface goes on straight and is seen
  int steps_;
};

/// A patch's share of one view.
struct PaintedShare {
  int patch;
  bool first; ///< no view before has painted the patch
  Index share;
};

/// By view, so that each photograph is read once, however many there are.
std::vector<std::vector<PaintedShare>> sharesByView(const PaintScene& scene, const PaintSources& sources)
{
  std::vector<std::vector<PaintedShare>> out(sources.views.size());
  for (Index i = 0; i < scene.patches.size(); ++i) {
    if (!scene.isSeen(i))
      continue;
    const Index begin = sources.blend.begin[i], end = sources.blend.begin[i + 1];
    int lowest = sources.blend.list[begin].view;
    for (Index s = begin; s < end; ++s)
      lowest = std::min(lowest, sources.blend.list[s].view);
    for (Index s = begin; s < end; ++s)
      out[sources.blend.list[s].view].push_back({int(i), sources.blend.list[s].view == lowest, s});
  }
  return out;
}

void paintShare(const PaintScene& scene, const PaintedView& view, const PaintedShare& part, std::vector<Image>& atlases)
{
  const PaintSources& sources = view.sources;
  PatchFrame frame(scene, part.patch);
  Image& atlas = atlases[frame.chart.atlas];
  const BlendShare& share = sources.blend.list[part.share];
  if (part.first)
    frame.forTexels([&](const Eigen::Vector2f&, int x, int y) {
      std::fill_n(atlas.pixel(frame.chart.x + x, frame.chart.y + y), 3, 0);
    });
  if (!frame.map.look(sources.views[share.view]))
    return;
  const PatchSampler sampler(scene, frame.map, view, part.patch);
  const bool plain = share.weights.minCoeff() == 1 && share.offsets.isZero(0);
  frame.forTexels([&](const Eigen::Vector2f& center, int x, int y) {
    std::uint8_t* pixel = atlas.pixel(frame.chart.x + x, frame.chart.y + y);
    Eigen::Vector3f color(pixel[0], pixel[1], pixel[2]);
    if (plain) {
      color += sampler(center);
    } else {
      const Eigen::Vector3f corners = frame.inside(center);
      if (const float weight = share.weights.dot(corners); weight > 0)
        color += weight * (sampler(center) + share.offsets * corners);
    }
    storeColor(color, pixel);
  });
}
} // namespace

void paintSeen(const PaintScene& scene, const PaintSources& sources, std::vector<Image>& atlases)
{
  std::size_t bytes = 0;
  for (const Image& atlas : atlases)
    bytes += atlas.data.size();
  sources.photos.setAside(bytes);
  forViews(sharesByView(scene, sources), sources.photos, [&](int v, const Image& photo, const auto& parts) {
    const PaintedView view{sources, photo, {sources.photometry, v, sources.views[v].camera()}};
    parallelFor(parts.size(), scene.threads, [&](Index i) { paintShare(scene, view, parts[i], atlases); });
  });
}

void paintTexels(const PaintScene& scene, const PaintSources& sources,
                 const std::vector<std::vector<PatchTexel>>& by_view, std::vector<Image>& atlases)
{
  forViews(by_view, sources.photos, [&](int v, const Image& photo, const std::vector<PatchTexel>& texels) {
    std::vector<std::size_t> runs; // first texel of each patch
    for (std::size_t k = 0; k < texels.size(); ++k)
      if (k == 0 || texels[k].patch != texels[k - 1].patch)
        runs.push_back(k);
    runs.push_back(texels.size());
    const PaintedView view{sources, photo, {sources.photometry, v, sources.views[v].camera()}};
    parallelFor(runs.size() - 1, scene.threads, [&](Index r) {
      PatchFrame frame(scene, texels[runs[r]].patch);
      if (!frame.map.look(sources.views[v]))
        return;
      const PatchSampler sampler(scene, frame.map, view, texels[runs[r]].patch);
      for (std::size_t k = runs[r]; k < runs[r + 1]; ++k)
        storeColor(sampler(frame.place(texels[k].x, texels[k].y)),
                   atlases[frame.chart.atlas].pixel(frame.chart.x + texels[k].x, frame.chart.y + texels[k].y));
    });
  });
}

Points patchColors(const PaintScene& scene, const std::vector<Image>& atlases)
{
  Points colors = Points::Constant(3, scene.patches.size(), -1.f);
  parallelFor(scene.patches.size(), scene.threads, [&](Index i) {
    if (!scene.isSeen(i))
      return;
    const Chart& chart = scene.chartOf(i);
    int sum[3] = {0, 0, 0}, count = 0;
    chart.texels.forTexels(scene.slots[i].number, [&](int x, int y) {
      const std::uint8_t* p = atlases[chart.atlas].pixel(chart.x + x, chart.y + y);
      for (int c = 0; c < 3; ++c)
        sum[c] += p[c];
      ++count;
    });
    if (count > 0)
      colors.col(i) = Eigen::Vector3f(sum[0], sum[1], sum[2]) / count;
  });
  return colors;
}

void paintUnseen(const PaintScene& scene, const Points& colors, std::vector<Image>& atlases, std::vector<Image>& masks)
{
  parallelFor(scene.patches.size(), scene.threads, [&](Index i) {
    if (scene.view[i] >= 0 || !scene.hasTexels(i))
      return;
    const Eigen::Matrix3f corners = colors.middleCols<3>(3 * i);
    const PatchFrame frame(scene, i);
    frame.forTexels([&](const Eigen::Vector2f& center, int x, int y) {
      x += frame.chart.x;
      y += frame.chart.y;
      storeColor(corners * frame.inside(center), atlases[frame.chart.atlas].pixel(x, y));
      *masks[frame.chart.atlas].pixel(x, y) = 255;
    });
  });
}

std::vector<TexelSlot> texelSlots(const std::vector<Chart>& charts, Index patches)
{
  std::vector<TexelSlot> slots(patches);
  for (std::size_t c = 0; c < charts.size(); ++c)
    for (std::size_t s = 0; s < charts[c].texels.patches.size(); ++s)
      slots[charts[c].texels.patches[s]] = {int(c), int(s)};
  return slots;
}

bool goesOn(const PaintScene& scene, Index patch, int side)
{
  const int other = scene.patches.neighbors(side, patch);
  return other >= 0 && scene.view[other] >= 0 &&
         scene.patches.normals.col(other).dot(scene.patches.normals.col(patch)) > crease_cosine;
}
} // namespace fresco::texture
