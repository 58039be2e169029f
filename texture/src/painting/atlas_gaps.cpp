// SPDX-License-Identifier: BSD-3-Clause
#include "painting/atlas_gaps.h"
#include "grid.h"
#include <algorithm>
#include <fresco/core/parallel.h>
namespace fresco::texture {
namespace {
/// Per texel the round in which it gets its colour: 1 = a chart's own, 0 = not yet.
std::vector<std::uint8_t> ownTexels(const std::vector<Chart>& charts, int atlas, const Image& image)
{
  std::vector<std::uint8_t> round(cellCount(image.width, image.height), 0);
  for (const Chart& chart : charts)
    if (chart.atlas == atlas)
      for (const TexelSpan& span : chart.texels.spans)
        std::fill_n(round.begin() + cellAt(chart.x + span.x, chart.y + span.y, image.width), span.length,
                    std::uint8_t(1));
  return round;
}

class Growth {
public:
  Growth(std::vector<std::uint8_t> round, Image& image) : round_(std::move(round)), image_(image) {}

  void run()
  {
    constexpr int far = 8; // texels: three halvings of the picture
    std::vector<std::size_t> front = firstFront();
    for (std::uint8_t now = 2; now < far + 2 && !front.empty(); ++now) {
      std::vector<std::size_t> next;
      for (const std::size_t at : front)
        paint(at, now);
      for (const std::size_t at : front)
        visitNeighbors(at, [&](std::size_t other) {
          if (round_[other] == 0) {
            round_[other] = waiting;
            next.push_back(other);
          }
        });
      front = std::move(next);
    }
  }

private:
  static constexpr std::uint8_t waiting = 255;

  template <typename Visit>
  void visitNeighbors(std::size_t at, const Visit& visit) const
  {
    const std::size_t width = image_.width;
    const std::size_t x = at % width;
    if (x > 0)
      visit(at - 1);
    if (x + 1 < width)
      visit(at + 1);
    if (at >= width)
      visit(at - width);
    if (at + width < round_.size())
      visit(at + width);
  }

  std::vector<std::size_t> firstFront()
  {
    std::vector<std::size_t> front;
    for (std::size_t at = 0; at < round_.size(); ++at)
      if (round_[at] == 0) {
        bool beside = false;
        visitNeighbors(at, [&](std::size_t other) { beside = beside || round_[other] == 1; });
        if (beside)
          front.push_back(at);
      }
    for (const std::size_t at : front)
      round_[at] = waiting;
    return front;
  }

  /// Mean of the neighbours of earlier rounds.
  void paint(std::size_t at, std::uint8_t now)
  {
    int sum[3] = {0, 0, 0}, count = 0;
    visitNeighbors(at, [&](std::size_t other) {
      if (round_[other] == 0 || round_[other] >= now)
        return;
      for (int c = 0; c < 3; ++c)
        sum[c] += image_.data[3 * other + c];
      ++count;
    });
    for (int c = 0; c < 3; ++c)
      image_.data[3 * at + c] = (sum[c] + count / 2) / count;
    round_[at] = now;
  }

  std::vector<std::uint8_t> round_;
  Image& image_;
};
} // namespace

void fillGaps(const std::vector<Chart>& charts, int threads, std::vector<Image>& atlases)
{
  parallelFor(
      atlases.size(), threads, [&](Index a) { Growth(ownTexels(charts, a, atlases[a]), atlases[a]).run(); }, 1);
}
} // namespace fresco::texture
