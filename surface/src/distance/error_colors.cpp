// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <fresco/core/require.h>
#include <fresco/surface/core/error_colors.h>
namespace fresco {
namespace {
using Color = Eigen::Matrix<std::uint8_t, 3, 1>;

// Pure hues from red (0) over green (0.5) to blue (1), brightest channel at full strength.
Color hueColor(float share)
{
  const float s = 4.f * std::clamp(share, 0.f, 1.f); // 0 red, 1 yellow, 2 green, 3 cyan, 4 blue
  const auto channel = [](float value) -> std::uint8_t { return std::lround(255.f * std::clamp(value, 0.f, 1.f)); };
  return {channel(2.f - s), channel(s < 2.f ? s : 4.f - s), channel(s - 2.f)};
}
} // namespace

Colors errorColors(const Eigen::VectorXf& distances, float largest)
{
  require(largest >= 0.f && std::isfinite(largest), "errorColors: largest distance ", largest,
          " is negative or not finite");
  Colors colors(3, distances.size());
  for (Index i = 0; i < distances.size(); ++i) {
    const float distance = distances[i];
    if (!std::isfinite(distance))
      colors.col(i).setConstant(128);
    else
      colors.col(i) = hueColor(distance <= 0.f ? 0.f : largest > 0.f ? distance / largest : 1.f);
  }
  return colors;
}
} // namespace fresco
