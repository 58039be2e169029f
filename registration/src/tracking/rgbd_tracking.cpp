// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/odometry.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
namespace fresco {
namespace {
using namespace tracking;

std::string nameOf(const RgbdTrackingOptions& options, Index frame)
{
  return options.names.empty() ? concat("frame ", frame) : options.names.at(frame);
}

/// Frames are read and prepared side by side, some at a time, and handed on in their order.
template <typename Visit>
void forEachFrame(const RgbdVideo& video, const RgbdTrackingOptions& options, const Progress& progress, const Visit& visit)
{
  constexpr Index batch = 16; // frames in memory
  const DepthRules rules{video.depth_unit, options.nearest, options.farthest};
  for (Index begin = 0; begin < video.count; begin += batch) {
    report(progress, "track", double(begin) / video.count);
    const Index count = std::min(batch, video.count - begin);
    std::vector<RgbdPyramid> pyramids(count);
    parallelFor(
        count, options.threads, [&](Index k) { pyramids[k] = makePyramid(video.read(begin + k), rules); }, 1);
    for (Index k = 0; k < count; ++k)
      visit(begin + k, std::move(pyramids[k]));
  }
}
} // namespace

RgbdTrackingResult trackRgbd(const RgbdVideo& video, const RgbdTrackingOptions& options, const Progress& progress)
{
  TrackingMap map;
  map.cameras.depth = video.camera;
  map.cameras.color = video.camera;
  map.frames.resize(video.count);
  Odometry odometry(map, options.threads);
  forEachFrame(video, options, progress,
               [&](Index frame, RgbdPyramid pyramid) { odometry.add(frame, std::move(pyramid)); });
  IsometryVector poses(map.key_frames.size(), Eigen::Isometry3d::Identity());
  for (const KeyFrameEdge& edge : map.edges)
    poses[edge.b] = poses[edge.a] * edge.T_a_b;
  RgbdTrackingResult result;
  for (const FramePlace& place : map.frames)
    result.poses.push_back(place.key_frame < 0 ? Pose() : Pose((poses[place.key_frame] * place.T_key_frame).matrix()));
  for (const KeyFrame& key : map.key_frames)
    result.key_frames.push_back(key.frame);
  return result;
}
} // namespace fresco
