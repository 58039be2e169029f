// SPDX-License-Identifier: BSD-3-Clause
#include "painting/color_growth.h"
#include "photographs/grid.h"
#include <algorithm>
#include <fresco/core/parallel.h>
namespace fresco::texture {
namespace {
class Growth {
public:
  Growth(ColorGrowth&& part, Image& atlas)
      : part_(std::move(part)), height_(part_.states.size() / std::max(1, part_.width)), atlas_(atlas)
  {}

  void run()
  {
    std::vector<std::size_t> front, next;
    for (std::size_t at = 0; at < part_.states.size(); ++at)
      if (part_.states[at] == ColorGrowth::open && besideKnown(at))
        front.push_back(at);
    for (int round = 0; round < part_.rounds && !front.empty(); ++round) {
      for (const std::size_t at : front)
        paint(at);
      for (const std::size_t at : front)
        part_.states[at] = ColorGrowth::known;
      next.clear();
      for (const std::size_t at : front)
        visitNeighbors(at, [&](std::size_t other) {
          if (part_.states[other] == ColorGrowth::open) {
            part_.states[other] = ColorGrowth::listed;
            next.push_back(other);
          }
        });
      front.swap(next);
    }
  }

private:
  template <typename Visit>
  void visitNeighbors(std::size_t at, const Visit& visit) const
  {
    constexpr int offsets[8][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
    const int x = at % part_.width, y = at / part_.width;
    for (int k = 0; k < (part_.diagonal ? 8 : 4); ++k) {
      const int i = x + offsets[k][0], j = y + offsets[k][1];
      if (i >= 0 && j >= 0 && i < part_.width && j < height_)
        visit(cellAt(i, j, part_.width));
    }
  }

  bool besideKnown(std::size_t at) const
  {
    bool beside = false;
    visitNeighbors(at, [&](std::size_t other) { beside = beside || part_.states[other] == ColorGrowth::known; });
    return beside;
  }

  std::uint8_t* texel(std::size_t at) const
  {
    return atlas_.pixel(part_.low.x() + at % part_.width, part_.low.y() + at / part_.width);
  }

  void paint(std::size_t at) const
  {
    int sum[3] = {0, 0, 0}, count = 0;
    visitNeighbors(at, [&](std::size_t other) {
      if (part_.states[other] != ColorGrowth::known)
        return;
      for (int c = 0; c < 3; ++c)
        sum[c] += texel(other)[c];
      ++count;
    });
    for (int c = 0; c < 3; ++c)
      texel(at)[c] = (sum[c] + count / 2) / count;
  }

  ColorGrowth part_;
  int height_;
  Image& atlas_;
};
} // namespace

void growColors(ColorGrowth growth, Image& atlas) { Growth(std::move(growth), atlas).run(); }

void fillGaps(const std::vector<Chart>& charts, int threads, std::vector<Image>& atlases)
{
  constexpr int far = 8; // texels: three halvings of the picture
  const auto fill = [&](Index a) {
    const int width = atlases[a].width;
    ColorGrowth growth{{0, 0}, width, false, far, {}};
    growth.states.assign(cellCount(width, atlases[a].height), ColorGrowth::open);
    for (const Chart& chart : charts)
      for (const TexelSpan& span : chart.texels.spans)
        if (chart.atlas == a)
          std::fill_n(growth.states.begin() + cellAt(chart.x + span.x, chart.y + span.y, width), span.length,
                      ColorGrowth::known);
    growColors(std::move(growth), atlases[a]);
  };
  parallelFor(atlases.size(), threads, fill, 1);
}
} // namespace fresco::texture
