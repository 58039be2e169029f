// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "filters/clouds.h"
/// A small laser scan with mixed pixels, made from three distances.
namespace fresco::test {
struct LabelledScan {
  Points points;           ///< seen from (0, 0, 0)
  std::vector<bool> mixed; ///< ranges between two surfaces
  std::vector<bool> leg;   ///< points of a leg that is one or two beams wide
};

/// A wall at x = 4, a board at x = 2 and a leg at x = 3; beams are one step wide, so that at borders ranges mix.
inline LabelledScan scanWithMixedPixels(float step, float noise, unsigned seed)
{
  std::mt19937 generator(seed);
  std::normal_distribution<float> normal(0, noise);
  std::uniform_real_distribution<float> uniform;
  const auto distance = [&](float azimuth, float elevation) {
    const float board = std::max(std::abs(azimuth), std::abs(elevation)), leg = std::abs(azimuth - 0.4f);
    return board < 0.2f ? 2.f : leg < 0.8f * step ? 3.f : 4.f;
  };
  std::vector<Eigen::Vector3f> points;
  LabelledScan scan;
  for (float azimuth = -0.5f; azimuth < 0.5f; azimuth += step)
    for (float elevation = -0.4f; elevation < 0.4f; elevation += step) {
      float range = distance(azimuth, elevation);
      bool mixed = false;
      if (uniform(generator) < 0.9f) {
        const float side = distance(azimuth + 0.3f * step, elevation + 0.3f * step);
        const float share = uniform(generator);
        if (side != range && range != 3 && side != 3 && share > 0.1f && share < 0.9f) {
          range = range + share * (side - range);
          mixed = true;
        }
      }
      const Eigen::Vector3f beam = Eigen::Vector3f(1, std::tan(azimuth), std::tan(elevation));
      points.push_back(beam * (range + normal(generator)));
      scan.mixed.push_back(mixed);
      scan.leg.push_back(!mixed && range == 3);
    }
  scan.points.resize(3, static_cast<Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    scan.points.col(static_cast<Index>(i)) = points[i];
  return scan;
}
} // namespace fresco::test
