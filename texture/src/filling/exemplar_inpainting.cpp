// SPDX-License-Identifier: BSD-3-Clause
#include "filling/exemplar_inpainting.h"
#include "filling/creases.h"
#include "filling/exemplar_synthesis.h"
#include "photographs/grid.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <numeric>
namespace fresco::texture {
namespace {
/// Texels of a chart that are unseen and joined, on one side of creases.
struct Hole {
  std::size_t chart;
  int piece;               ///< see smoothPieces()
  Eigen::AlignedBox2i box; ///< in the chart's texels
  std::vector<int> texels; ///< index into the chart's owners
};

struct ChartTexels {
  const Chart& chart;
  const Image& mask;
  const std::vector<int>& pieces; ///< of all patches

  int pieceOf(std::size_t slot) const { return pieces[chart.texels.patches[slot]]; }
  bool isUnseen(int x, int y) const { return *mask.pixel(chart.x + x, chart.y + y) != 0; }
};

std::vector<Hole> holesOf(const ChartTexels& texels, std::size_t number)
{
  constexpr std::size_t least_texels = 300; // smaller holes have no room for a structure
  const int w = texels.chart.width, h = texels.chart.height;
  std::vector<int> open(cellCount(w, h), -1); // piece of texels that are unseen and of no hole yet
  for (std::size_t s = 0; s < texels.chart.texels.patches.size(); ++s)
    texels.chart.texels.forTexels(s, [&](int x, int y) {
      if (texels.isUnseen(x, y))
        open[cellAt(x, y, w)] = texels.pieceOf(s);
    });
  std::vector<Hole> holes;
  for (int start = 0; start < w * h; ++start) {
    if (open[start] < 0)
      continue;
    Hole hole{number, open[start], {}, {start}};
    open[start] = -1;
    for (std::size_t k = 0; k < hole.texels.size(); ++k) {
      const int x = hole.texels[k] % w, y = hole.texels[k] / w;
      hole.box.extend(Eigen::Vector2i(x, y));
      for (int j = std::max(0, y - 1); j <= std::min(h - 1, y + 1); ++j)
        for (int i = std::max(0, x - 1); i <= std::min(w - 1, x + 1); ++i)
          if (const int at = j * w + i; open[at] == hole.piece) {
            open[at] = -1;
            hole.texels.push_back(at);
          }
    }
    if (hole.texels.size() >= least_texels)
      holes.push_back(std::move(hole));
  }
  return holes;
}

/// The hole's box and as much again to each side, within the chart; around a long one as around a square of its area.
Eigen::AlignedBox2i surroundingsOf(const Hole& hole, const Chart& chart)
{
  constexpr int least_surroundings = 64; // texels around the box: several windows even for a small hole
  const int spare = std::max<int>(least_surroundings, std::sqrt(hole.box.sizes().cast<float>().prod()));
  const Eigen::Vector2i low = (hole.box.min().array() - spare).max(0),
                        high = (hole.box.max().array() + spare).min(Eigen::Array2i(chart.width - 1, chart.height - 1));
  return {low, high};
}

HolePicture pictureOf(const ChartTexels& texels, const Hole& hole, const Eigen::AlignedBox2i& box, const Image& atlas)
{
  const Chart& chart = texels.chart;
  HolePicture out;
  out.width = box.sizes().x() + 1;
  out.height = box.sizes().y() + 1;
  out.color.resize(cellCount(out.width, out.height), HolePicture::Color{});
  out.state.resize(out.color.size(), HolePicture::outside);
  const auto set = [&](int at, std::uint8_t state) { // texels of other holes are not even read: they are being written
    const int x = at % chart.width, y = at / chart.width;
    const std::uint8_t* p = atlas.pixel(chart.x + x, chart.y + y);
    const std::size_t pixel = out.at(x - box.min().x(), y - box.min().y());
    out.color[pixel] = HolePicture::stored(Eigen::Vector4f(p[0], p[1], p[2], 0));
    out.state[pixel] = state;
  };
  const auto addSpan = [&](const TexelSpan& span) {
    if (span.y < box.min().y() || span.y > box.max().y())
      return;
    for (int x = std::max<int>(span.x, box.min().x()); x <= std::min(span.x + span.length - 1, box.max().x()); ++x)
      if (!texels.isUnseen(x, span.y))
        set(span.y * chart.width + x, HolePicture::known);
  };
  for (std::size_t s = 0; s < chart.texels.patches.size(); ++s)
    if (texels.pieceOf(s) == hole.piece)
      std::for_each(chart.texels.spans.begin() + chart.texels.begin[s],
                    chart.texels.spans.begin() + chart.texels.begin[s + 1], addSpan);
  for (const int at : hole.texels)
    set(at, HolePicture::hole);
  return out;
}

/// Sum of each row's pixels within 8 texels, of those inside the picture; then transposed.
/// @param value sum of colours, count
void sumRows(std::vector<Eigen::Vector4f>& value, int width, int height)
{
  constexpr int smooth_reach = 8; // texels: coarser structure is what the smooth colours hold
  std::vector<Eigen::Vector4f> out(value.size());
  for (int y = 0; y < height; ++y) {
    Eigen::Vector4f sum = Eigen::Vector4f::Zero();
    const Eigen::Vector4f* row = value.data() + cellAt(0, y, width);
    for (int x = -smooth_reach; x < width; ++x) {
      if (x + smooth_reach < width)
        sum += row[x + smooth_reach];
      if (x - smooth_reach - 1 >= 0)
        sum -= row[x - smooth_reach - 1];
      if (x >= 0)
        out[cellAt(y, x, height)] = sum;
    }
  }
  value.swap(out);
}

/// The picture without its fine structure.
std::vector<Eigen::Vector4f> smoothed(const HolePicture& picture)
{
  std::vector<Eigen::Vector4f> value;
  for (std::size_t i = 0; i < picture.color.size(); ++i)
    value.push_back(picture.state[i] == HolePicture::outside
                        ? Eigen::Vector4f::Zero()
                        : Eigen::Vector4f(HolePicture::levels(picture.color[i]) + Eigen::Vector4f::UnitW()));
  for (int round = 0; round < 2; ++round) { // box over box: nearly a Gaussian
    sumRows(value, picture.width, picture.height);
    sumRows(value, picture.height, picture.width);
    for (Eigen::Vector4f& v : value)
      v = v.w() > 0.5f ? Eigen::Vector4f(v / v.w()) : Eigen::Vector4f::Zero();
  }
  for (Eigen::Vector4f& v : value)
    v.w() = 0;
  return value;
}

bool fill(const ChartTexels& texels, const Hole& hole, Image& atlas)
{
  constexpr int least_radius = 4;     // texels: thinner holes have no room for a structure
  constexpr double most_texels = 8e6; // of a hole with its surroundings: bounds the time
  const Eigen::AlignedBox2i box = surroundingsOf(hole, texels.chart);
  if ((box.sizes().cast<double>().array() + 1).prod() > most_texels)
    return false;
  HolePicture picture = pictureOf(texels, hole, box, atlas);
  if (holeRadius(picture) < least_radius)
    return false;
  const std::vector<Eigen::Vector4f> base = smoothed(picture);
  for (std::size_t i = 0; i < base.size(); ++i)
    picture.color[i] = picture.state[i] == HolePicture::known
                           ? HolePicture::stored(HolePicture::levels(picture.color[i]) - base[i])
                           : HolePicture::Color{};
  if (!synthesizeHole(picture, hole.chart * 1000003 + hole.texels.front()))
    return false;
  for (const int at : hole.texels) {
    const int x = at % texels.chart.width, y = at / texels.chart.width;
    const std::size_t i = picture.at(x - box.min().x(), y - box.min().y());
    std::uint8_t* p = atlas.pixel(texels.chart.x + x, texels.chart.y + y);
    const Eigen::Vector4f color = base[i] + HolePicture::levels(picture.color[i]);
    for (int c = 0; c < 3; ++c)
      p[c] = std::lround(std::clamp(color[c], 0.f, 255.f));
  }
  return true;
}
} // namespace

Index inpaintByExample(const PaintScene& scene, const std::vector<Image>& masks, std::vector<Image>& atlases)
{
  const std::vector<int> pieces = smoothPieces(scene.patches);
  const auto texelsOf = [&](std::size_t c) {
    return ChartTexels{scene.charts[c], masks[scene.charts[c].atlas], pieces};
  };
  std::vector<std::vector<Hole>> by_chart(scene.charts.size());
  const auto findHoles = [&](Index c) { by_chart[c] = holesOf(texelsOf(c), c); };
  parallelFor(scene.charts.size(), scene.threads, findHoles, 1);
  std::vector<Hole> holes;
  for (auto& list : by_chart)
    std::move(list.begin(), list.end(), std::back_inserter(holes));
  // large ones first, so that no thread is left with one at the end; holes do not read each other's texels
  std::stable_sort(holes.begin(), holes.end(),
                   [](const Hole& a, const Hole& b) { return a.texels.size() > b.texels.size(); });
  std::vector<Index> filled(holes.size(), 0);
  const auto fillHole = [&](Index h) {
    if (fill(texelsOf(holes[h].chart), holes[h], atlases[scene.charts[holes[h].chart].atlas]))
      filled[h] = holes[h].texels.size();
  };
  parallelFor(holes.size(), scene.threads, fillHole, 1);
  return std::accumulate(filled.begin(), filled.end(), Index{0});
}
} // namespace fresco::texture
