// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <fresco/simulation/sensors/picture.h>
namespace fresco::simulation {
Picture::Picture(int width, int height, const Eigen::Vector3f& color)
{
  levels_.push_back({width, height, std::vector<Eigen::Vector3f>(width * height, color)});
}

Picture::Level Picture::halve(const Level& fine)
{
  Level coarse{(fine.width + 1) / 2, (fine.height + 1) / 2, {}};
  coarse.data.resize(coarse.width * coarse.height);
  for (int y = 0; y < coarse.height; ++y)
    for (int x = 0; x < coarse.width; ++x) {
      const int right = std::min(2 * x + 1, fine.width - 1), below = std::min(2 * y + 1, fine.height - 1);
      coarse.at(x, y) =
          0.25f * (fine.at(2 * x, 2 * y) + fine.at(right, 2 * y) + fine.at(2 * x, below) + fine.at(right, below));
    }
  return coarse;
}

void Picture::buildLevels()
{
  levels_.resize(1);
  while (levels_.back().width > 1 || levels_.back().height > 1)
    levels_.push_back(halve(levels_.back()));
}

Eigen::Vector3f Picture::bilinear(const Level& level, float u, float v)
{
  const float x = std::clamp(u * level.width - 0.5f, 0.f, static_cast<float>(level.width - 1));
  const float y = std::clamp(v * level.height - 0.5f, 0.f, static_cast<float>(level.height - 1));
  const int x0 = x, y0 = y;
  const int x1 = std::min(x0 + 1, level.width - 1), y1 = std::min(y0 + 1, level.height - 1);
  const float tx = x - x0, ty = y - y0;
  return (1 - ty) * ((1 - tx) * level.at(x0, y0) + tx * level.at(x1, y0)) +
         ty * ((1 - tx) * level.at(x0, y1) + tx * level.at(x1, y1));
}

Eigen::Vector3f Picture::sample(float u, float v, float footprint) const
{
  const float last = levels_.size() - 1;
  const float depth = std::clamp(std::log2(std::max(footprint, 1e-6f)), 0.f, last);
  const int level = depth;
  const Eigen::Vector3f fine = bilinear(levels_[level], u, v);
  const float t = depth - level;
  if (t <= 0.f)
    return fine;
  return (1 - t) * fine + t * bilinear(levels_[level + 1], u, v);
}
} // namespace fresco::simulation
