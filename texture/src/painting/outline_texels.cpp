// SPDX-License-Identifier: BSD-3-Clause
#include "painting/outline_texels.h"
#include "painting/color_growth.h"
#include "painting/patch_frame.h"
#include "photographs/grid.h"
#include "views/vertex_views.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <limits>
namespace fresco::texture {
namespace {
enum : int { as_painted = -2, none = -1 }; // instead of a view

/// Decides for the texels of one patch.
class PatchChoice {
public:
  PatchChoice(const PaintScene& scene, const PaintSources& sources, Index patch)
      : sources_(sources), patch_(patch), frame_(scene, patch)
  {}

  /// Whether an outline comes near the patch in a view that paints it.
  bool isNearOutline()
  {
    const auto& blend = sources_.blend;
    for (Index s = blend.begin[patch_]; s < blend.begin[patch_ + 1]; ++s) {
      const int view = blend.list[s].view;
      if (!frame_.map.look(sources_.views[view]))
        continue;
      const Eigen::Matrix<float, 2, 3> corners = frame_.map.cornerPixels();
      constexpr float spare = 3; // pixels: texels of the border
      if (sources_.masks[view].touches(corners.rowwise().minCoeff().array() - spare,
                                       corners.rowwise().maxCoeff().array() + spare))
        return true;
    }
    return false;
  }

  /// View of each texel, `as_painted` or `none`.
  std::vector<int> run()
  {
    std::vector<int> choice(frame_.texels(), as_painted);
    const auto& blend = sources_.blend;
    for (Index s = blend.begin[patch_]; s < blend.begin[patch_ + 1]; ++s) {
      const BlendShare& share = blend.list[s];
      forMixed(share.view, [&](std::size_t k, const Eigen::Vector2f& center) {
        if (share.weights.dot(frame_.inside(center)) > least_share)
          choice[k] = none;
      });
    }
    if (std::count(choice.begin(), choice.end(), none) > 0)
      chooseOthers(choice);
    return choice;
  }

private:
  /// visit(number of the texel, its centre) for each texel that the view shows mixed
  /// @return false if a corner is not in front of the camera
  template <typename Visit>
  bool forMixed(int view, const Visit& visit)
  {
    if (!frame_.map.look(sources_.views[view]))
      return false;
    std::size_t k = 0;
    frame_.forTexels([&](const Eigen::Vector2f& center, int, int) {
      if (sources_.masks[view].holds(frame_.map.pixel(center.x(), center.y()),
                                     frame_.map.inverseDepth(center.x(), center.y())))
        visit(k, center);
      ++k;
    });
    return true;
  }

  void chooseOthers(std::vector<int>& choice)
  {
    const Candidates& all = sources_.candidates;
    std::vector<std::pair<float, int>> ranked; // quality, view
    for (Index c = all.begin[patch_]; c < all.begin[patch_ + 1]; ++c)
      ranked.emplace_back(all.list[c].quality * std::exp2(-sources_.penalties[c]), all.list[c].view);
    std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    for (const auto& [quality, view] : ranked) {
      std::vector<char> mixed(choice.size(), 0);
      if (!forMixed(view, [&](std::size_t k, const Eigen::Vector2f&) { mixed[k] = 1; }))
        continue;
      for (std::size_t k = 0; k < choice.size(); ++k)
        if (choice[k] == none && !mixed[k])
          choice[k] = view;
      if (std::count(choice.begin(), choice.end(), none) == 0)
        return;
    }
  }

  const PaintSources& sources_;
  Index patch_;
  PatchFrame frame_;
};

void append(const PaintScene& scene, Index patch, const std::vector<int>& choice, OutlineTexels& out)
{
  if (std::all_of(choice.begin(), choice.end(), [](int view) { return view == none; })) {
    out.hidden.push_back(patch);
    return;
  }
  std::size_t k = 0;
  scene.chartOf(patch).texels.forTexels(scene.slots[patch].number, [&](int x, int y) {
    const PatchTexel texel{int(patch), x, y};
    if (choice[k] >= 0)
      out.by_view[choice[k]].push_back(texel);
    else if (choice[k] == none)
      out.unknown.push_back(texel);
    ++k;
  });
}

/// Gives the unknown texels of one chart the colours around them.
void fillChart(const PaintScene& scene, const Chart& chart, const std::vector<PatchTexel>& unknown, Image& atlas)
{
  ColorGrowth growth{{chart.x, chart.y}, chart.width, true, std::numeric_limits<int>::max(), {}};
  growth.states.assign(cellCount(chart.width, chart.height), ColorGrowth::left_alone);
  const auto set = [&](int x, int y, ColorGrowth::State state) { growth.states[cellAt(x, y, chart.width)] = state; };
  for (std::size_t s = 0; s < chart.texels.patches.size(); ++s)
    if (scene.isSeen(chart.texels.patches[s]))
      chart.texels.forTexels(s, [&](int x, int y) { set(x, y, ColorGrowth::known); });
  for (const PatchTexel& texel : unknown)
    set(texel.x, texel.y, ColorGrowth::open);
  growColors(std::move(growth), atlas);
}
} // namespace

OutlineTexels findOutlineTexels(const PaintScene& scene, const PaintSources& sources)
{
  OutlineTexels out;
  out.by_view.resize(sources.views.size());
  std::vector<char> near(scene.patches.size(), 0);
  parallelFor(scene.patches.size(), scene.threads,
              [&](Index i) { near[i] = scene.isSeen(i) && PatchChoice(scene, sources, i).isNearOutline(); });
  std::vector<Index> patches;
  for (Index i = 0; i < scene.patches.size(); ++i)
    if (near[i])
      patches.push_back(i);
  std::vector<std::vector<int>> choices(patches.size());
  parallelFor(patches.size(), scene.threads,
              [&](Index k) { choices[k] = PatchChoice(scene, sources, patches[k]).run(); });
  for (std::size_t k = 0; k < patches.size(); ++k)
    append(scene, patches[k], choices[k], out);
  return out;
}

void fillUnknown(const PaintScene& scene, const std::vector<PatchTexel>& unknown, std::vector<Image>& atlases,
                 std::vector<Image>& masks)
{
  std::vector<std::vector<PatchTexel>> by_chart(scene.charts.size());
  for (const PatchTexel& texel : unknown) {
    const Chart& chart = scene.chartOf(texel.patch);
    *masks[chart.atlas].pixel(chart.x + texel.x, chart.y + texel.y) = 255;
    by_chart[scene.slots[texel.patch].chart].push_back(texel);
  }
  const auto fill = [&](Index c) {
    if (!by_chart[c].empty())
      fillChart(scene, scene.charts[c], by_chart[c], atlases[scene.charts[c].atlas]);
  };
  parallelFor(by_chart.size(), scene.threads, fill, 1);
}
} // namespace fresco::texture
