// SPDX-License-Identifier: BSD-3-Clause
#include "fusion/depth_frame.h"
#include <algorithm>
#include <fresco/core/parallel.h>
#include <utility>
namespace fresco::fusion {
namespace {
constexpr int tile = 16; // pixels: about what a brick of cells covers at two metres
} // namespace

DepthFrame::DepthFrame(const CameraModel& camera, DepthImage image, const Eigen::Isometry3d& T_world_camera,
                       int threads)
    : width(camera.width), height(camera.height), fx(camera.fx), fy(camera.fy), cx(camera.cx - 0.5),
      cy(camera.cy - 0.5), depth(std::move(image)), R_world_camera(T_world_camera.linear().cast<float>()),
      center(T_world_camera.translation().cast<float>()), tile_columns_((width + tile - 1) / tile),
      tile_rows_((height + tile - 1) / tile), tiles_(Index(tile_columns_) * tile_rows_)
{
  parallelFor(
      tile_rows_, threads,
      [&](Index row) {
        auto rows = depth.middleRows(row * tile, std::min<Index>(tile, height - row * tile));
        rows = (rows > 0.f && rows.isFinite()).select(rows, 0.f);
        for (int column = 0; column < tile_columns_; ++column) {
          const auto part = rows.middleCols(column * tile, std::min(tile, width - column * tile));
          tiles_[row * tile_columns_ + column] = {part.minCoeff(), part.maxCoeff()};
        }
      },
      4);
}

DepthRange DepthFrame::range(float left, float top, float right, float bottom) const
{
  DepthRange all;
  if (!(right >= 0 && bottom >= 0 && left < width && top < height))
    return all;
  const int u0 = std::max(left, 0.f) / tile, u1 = std::min<float>(right, width - 1) / tile;
  const int v0 = std::max(top, 0.f) / tile, v1 = std::min<float>(bottom, height - 1) / tile;
  for (int v = v0; v <= v1; ++v)
    for (int u = u0; u <= u1; ++u) {
      const DepthRange& part = tiles_[v * tile_columns_ + u];
      all = {std::min(all.least, part.least), std::max(all.greatest, part.greatest)};
    }
  if (left < 0 || top < 0 || right > width - 1 || bottom > height - 1)
    all.least = 0.f;
  return all;
}
} // namespace fresco::fusion
