// SPDX-License-Identifier: BSD-3-Clause
#include "views/depth_map.h"
#include <algorithm>
#include <cmath>
namespace fresco::texture {
namespace {
constexpr int packet = 8; // rays traced together

/// Rays through cells x .. x+7 of row y.
RayPacket<packet> raysOf(const Projector& view, const DepthMap& map, int x, int y)
{
  RayPacket<packet> rays;
  for (int i = 0; i < packet; ++i)
    rays[i] = {view.center(), view.ray({(std::min(x + i, map.width - 1) + 0.5) * map.step, (y + 0.5) * map.step})};
  return rays;
}

/// select() over the square of `radius` cells around each cell.
template <typename Select>
DepthMap selectWithin(const DepthMap& map, int radius, const Select& select)
{
  DepthMap rows = map, out;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      float& value = rows.depth[static_cast<std::size_t>(y) * map.width + x];
      for (int i = std::max(0, x - radius); i <= std::min(map.width - 1, x + radius); ++i)
        value = select(value, map.at(i, y));
    }
  out = rows;
  for (int y = 0; y < map.height; ++y)
    for (int j = std::max(0, y - radius); j <= std::min(map.height - 1, y + radius); ++j)
      for (int x = 0; x < map.width; ++x) {
        float& value = out.depth[static_cast<std::size_t>(y) * map.width + x];
        value = select(value, rows.at(x, j));
      }
  return out;
}
} // namespace

DepthMap depthMap(const RayScene& scene, const Projector& view, Index most_cells)
{
  DepthMap map;
  const double pixels = static_cast<double>(view.camera().width) * view.camera().height;
  map.step = std::max(1.0, std::sqrt(pixels / static_cast<double>(most_cells)));
  map.width = std::ceil(view.camera().width / map.step);
  map.height = std::ceil(view.camera().height / map.step);
  map.depth.reserve(static_cast<std::size_t>(map.width) * map.height);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; x += packet) {
      const HitPacket<packet> hits = scene.intersect(raysOf(view, map, x, y), RayOrder::coherent);
      for (int i = 0; i < std::min(packet, map.width - x); ++i)
        map.depth.push_back(hits[i].distance);
    }
  return map;
}

DepthMap nearestWithin(const DepthMap& map, int radius)
{
  return selectWithin(map, radius, [](float a, float b) { return std::min(a, b); });
}

DepthMap farthestWithin(const DepthMap& map, int radius)
{
  return selectWithin(map, radius, [](float a, float b) { return std::max(a, b); });
}
} // namespace fresco::texture
