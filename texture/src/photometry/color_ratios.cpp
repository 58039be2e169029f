// SPDX-License-Identifier: BSD-3-Clause
#include "photometry/color_ratios.h"
#include <algorithm>
#include <cmath>
#include <numeric>
namespace fresco::texture {
namespace {
bool isClear(const Candidate& c)
{
  constexpr int extreme = 12; // grey levels from black and white: there a value says little of the light
  return !c.clipped &&
         std::all_of(c.color.begin(), c.color.end(), [](int v) { return v >= extreme && v <= 255 - extreme; });
}

Eigen::Vector3f logColor(const Candidate& c)
{
  return Eigen::Vector3f(c.color[0], c.color[1], c.color[2]).array().log();
}

/// NaN unless both are clearly more than noise: an outline of what stands before a plain surface is no sharpness.
/// @param log_light of the first view over the second
float contrastRatio(const Candidate& first, const Candidate& second, float log_light)
{
  constexpr float noise = 24; // square of half grey levels
  const float a = first.contrast * first.contrast, b = second.contrast * second.contrast;
  return std::min(a, b) < 4 * noise ? NAN : std::log2((a + noise) / (b + noise)) - 2 * float(M_LOG2E) * log_light;
}

ColorRatio ratioOf(const Candidate& first, const Candidate& second)
{
  const Eigen::Vector3f a = logColor(first), b = logColor(second);
  const float contrast = contrastRatio(first, second, (a - b).mean());
  return {a - b, 0.5f * (a + b), {first.squaredRadius(), second.squaredRadius()}, contrast};
}

void addPatch(const Candidates& candidates, const std::vector<int>& owner, Index patch, ColorRatios& pairs)
{
  constexpr float trusted = 0.2f; // of the best quality: views that show much less blur the colour
  const Candidate* list = candidates.of(patch);
  const float best = candidates.bestQuality(patch);
  for (Index i = 0; i < candidates.count(patch); ++i) {
    if (list[i].quality < trusted * best || !isClear(list[i]))
      continue;
    for (Index j = i + 1; j < candidates.count(patch); ++j)
      if (const int a = owner[list[i].view], b = owner[list[j].view];
          a != b && list[j].quality >= trusted * best && isClear(list[j])) {
        auto& ratios = pairs[{a, b}];
        if (Index(ratios.size()) < median_samples)
          ratios.push_back(ratioOf(list[i], list[j]));
      }
  }
}
} // namespace

ColorRatios collectColorRatios(const Candidates& candidates, const std::vector<int>& owner)
{
  const Index patches = candidates.begin.size() - 1;
  const Index taken = std::min(patches, most_compared);
  ColorRatios pairs;
  const Index golden = 0.618 * taken;
  Index step = golden | 1;
  while (taken > 1 && std::gcd(step, taken) != 1)
    step += 2;
  for (Index k = 0, at = 0; k < taken; ++k, at = (at + step) % taken)
    addPatch(candidates, owner, at * patches / taken, pairs);
  return pairs;
}
} // namespace fresco::texture
