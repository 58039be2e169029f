// SPDX-License-Identifier: BSD-3-Clause
#include "charts/atlas_packing.h"
#include <gtest/gtest.h>
#include <random>
using namespace fresco::texture;
namespace fresco::test {
namespace {
/// Discs and rectangles of 4 to 60 texels.
std::vector<Chart> makeCharts(int count)
{
  std::mt19937 random(7);
  std::uniform_int_distribution<int> length(4, 60);
  std::vector<Chart> charts(count);
  for (std::size_t c = 0; c < charts.size(); ++c) {
    Chart& chart = charts[c];
    chart.width = length(random);
    chart.height = c % 2 ? chart.width : length(random);
    std::vector<int> owner(static_cast<std::size_t>(chart.width) * chart.height, 0);
    const float radius = 0.5f * static_cast<float>(chart.width);
    for (int y = 0; c % 2 && y < chart.height; ++y)
      for (int x = 0; x < chart.width; ++x)
        if (std::hypot(static_cast<float>(x) + 0.5f - radius, static_cast<float>(y) + 0.5f - radius) > radius)
          owner[static_cast<std::size_t>(y) * chart.width + x] = -1;
    chart.texels = OwnedTexels::from(owner, chart.width);
  }
  return charts;
}

/// How often each texel of each atlas is taken.
std::vector<std::vector<int>> takenTexels(const std::vector<Chart>& charts, const Packing& packing)
{
  std::vector<std::vector<int>> taken(packing.atlases,
                                      std::vector<int>(static_cast<std::size_t>(packing.side) * packing.side, 0));
  for (const Chart& chart : charts) {
    EXPECT_TRUE(chart.atlas >= 0 && chart.atlas < packing.atlases);
    EXPECT_TRUE(chart.x >= 0 && chart.y >= 0 && chart.x + chart.width <= packing.side &&
                chart.y + chart.height <= packing.side);
    for (const TexelSpan& span : chart.texels.spans)
      for (int x = span.x; x < span.x + span.length; ++x)
        ++taken[chart.atlas][static_cast<std::size_t>(chart.y + span.y) * packing.side + chart.x + x];
  }
  return taken;
}

class TexturePacking : public testing::TestWithParam<int> {};

TEST_P(TexturePacking, NoTexelIsTakenTwiceAndFewAreWasted)
{
  constexpr int largest = 512;
  std::vector<Chart> charts = makeCharts(GetParam());
  const Packing packing = packCharts(charts, largest);
  std::size_t owned = 0;
  for (const std::vector<int>& atlas : takenTexels(charts, packing))
    for (const int times : atlas) {
      EXPECT_LE(times, 1);
      owned += times;
    }
  EXPECT_LE(packing.side, largest);
  const double texels = static_cast<double>(packing.side) * packing.side * packing.atlases;
  EXPECT_DOUBLE_EQ(packing.used, owned / texels);
  EXPECT_GT(packing.used, 0.7);
  if (packing.atlases > 1) { // not more of them than needed
    EXPECT_GT(owned, 0.7 * (packing.atlases - 1) * largest * largest);
  }
}

// One atlas; two of which the second would be nearly empty at the largest size; several.
INSTANTIATE_TEST_SUITE_P(Counts, TexturePacking, testing::Values(60, 250, 300, 900));

TEST(TexturePackingOf, ALargestSideIsKept)
{
  std::vector<Chart> charts = makeCharts(300);
  const Packing packing = packCharts(charts, 160);
  EXPECT_LE(packing.side, 160);
  for (const std::vector<int>& atlas : takenTexels(charts, packing))
    EXPECT_LE(*std::max_element(atlas.begin(), atlas.end()), 1);
}
} // namespace
} // namespace fresco::test
