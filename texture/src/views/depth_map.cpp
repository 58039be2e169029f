// SPDX-License-Identifier: BSD-3-Clause
#include "views/depth_map.h"
#include "photographs/grid.h"
#include <algorithm>
#include <cmath>
#include <limits>
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

/// Cells x0 .. x1 - 1 of rows y0 .. y1 - 1.
struct Block {
  int x0, y0, x1, y1;
};

void trace(const RayScene& scene, const Projector& view, const Block& block, DepthMap& map)
{
  for (int y = block.y0; y < block.y1; ++y)
    for (int x = block.x0; x < block.x1; x += packet) {
      const HitPacket<packet> hits = scene.intersect(raysOf(view, map, x, y), RayOrder::coherent);
      float* depth = map.depth.data() + cellAt(x, y, map.width);
      for (int i = 0; i < std::min(packet, block.x1 - x); ++i)
        depth[i] = std::min(depth[i], hits[i].distance);
    }
}

/// Whether a ray through the block may meet the box: whether the cone around its rays meets the ball around the box.
bool mayHit(const Eigen::AlignedBox3f& box, const Projector& view, const Block& block, float step)
{
  constexpr float spare = 1.1f; // what a lens bends between the corners
  const auto ray = [&](double x, double y) -> Eigen::Vector3f { return view.ray({x * step, y * step}).normalized(); };
  const Eigen::Vector3f axis = ray(0.5 * (block.x0 + block.x1), 0.5 * (block.y0 + block.y1));
  float half = 0;
  for (const int x : {block.x0, block.x1})
    for (const int y : {block.y0, block.y1})
      half = std::max(half, spare * std::acos(std::min(1.f, axis.dot(ray(x, y)))));
  const Eigen::Vector3f to = box.center() - view.center();
  const float distance = to.norm(), radius = 0.5f * box.diagonal().norm();
  return distance <= radius ||
         std::acos(std::clamp(axis.dot(to) / distance, -1.f, 1.f)) <= half + std::asin(radius / distance);
}
/// @param operation of OpenCV
DepthMap filtered(const DepthMap& map, int radius, const CellBox& cells, int operation)
{
  DepthMap out = map;
  const cv::Rect box(cells.x0, cells.y0, cells.x1 - cells.x0 + 1, cells.y1 - cells.y0 + 1);
  const cv::Mat from(map.height, map.width, CV_32F, const_cast<float*>(map.depth.data()));
  cv::Mat to(map.height, map.width, CV_32F, out.depth.data());
  cv::Mat part = to(box); // what is beside the box is read, too
  cv::morphologyEx(from(box), part, operation, cv::Mat::ones(2 * radius + 1, 2 * radius + 1, CV_8U));
  return out;
}
} // namespace

float depthStep(const CameraModel& camera, Index most_cells)
{
  return std::max(1.0, std::sqrt(1.0 * cellCount(camera.width, camera.height) / most_cells));
}

DepthMap emptyMap(const CameraModel& camera, Index most_cells)
{
  DepthMap map;
  map.step = depthStep(camera, most_cells);
  map.width = std::ceil(camera.width / map.step);
  map.height = std::ceil(camera.height / map.step);
  map.depth.assign(cellCount(map.width, map.height), std::numeric_limits<float>::infinity());
  return map;
}

DepthMap depthMap(const RayScene& scene, const Projector& view, Index most_cells)
{
  DepthMap map = emptyMap(view.camera(), most_cells);
  trace(scene, view, {0, 0, map.width, map.height}, map);
  return map;
}

void addPart(const ScenePart& part, const Projector& view, DepthMap& map)
{
  constexpr int side = 64; // cells of a block, a multiple of a packet
  for (int y = 0; y < map.height; y += side)
    for (int x = 0; x < map.width; x += side)
      if (const Block block{x, y, std::min(x + side, map.width), std::min(y + side, map.height)};
          mayHit(part.box, view, block, map.step))
        trace(part.scene, view, block, map);
}

DepthMap nearestWithin(const DepthMap& map, int radius, const CellBox& cells)
{
  return filtered(map, radius, cells, cv::MORPH_ERODE);
}

DepthMap farthestWithin(const DepthMap& map, int radius, const CellBox& cells)
{
  return filtered(map, radius, cells, cv::MORPH_DILATE);
}
} // namespace fresco::texture
