// SPDX-License-Identifier: BSD-3-Clause
#include "views/depth_map.h"
#include "grid.h"
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
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

} // namespace

float depthStep(const CameraModel& camera, Index most_cells)
{
  return std::max(1.0, std::sqrt(1.0 * cellCount(camera.width, camera.height) / most_cells));
}

DepthMap depthMap(const RayScene& scene, const Projector& view, Index most_cells)
{
  DepthMap map;
  map.step = depthStep(view.camera(), most_cells);
  map.width = std::ceil(view.camera().width / map.step);
  map.height = std::ceil(view.camera().height / map.step);
  map.depth.reserve(cellCount(map.width, map.height));
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; x += packet) {
      const HitPacket<packet> hits = scene.intersect(raysOf(view, map, x, y), RayOrder::coherent);
      for (int i = 0; i < std::min(packet, map.width - x); ++i)
        map.depth.push_back(hits[i].distance);
    }
  return map;
}

DepthMap nearestWithin(DepthMap map, int radius)
{
  cv::Mat depth(map.height, map.width, CV_32F, map.depth.data());
  cv::erode(depth, depth, cv::Mat::ones(2 * radius + 1, 2 * radius + 1, CV_8U));
  return map;
}

DepthMap farthestWithin(DepthMap map, int radius)
{
  cv::Mat depth(map.height, map.width, CV_32F, map.depth.data());
  cv::dilate(depth, depth, cv::Mat::ones(2 * radius + 1, 2 * radius + 1, CV_8U));
  return map;
}
} // namespace fresco::texture
