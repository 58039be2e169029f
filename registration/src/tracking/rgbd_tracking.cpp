// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/color_camera.h"
#include "tracking/loop_closure.h"
#include "tracking/map_refinement.h"
#include "tracking/odometry.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <optional>
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

/// Pairs of frames a moment apart, spread over the video, that depth alone aligns and that are turned against each other.
std::vector<CalibrationPair> calibrationPairs(const RgbdVideo& video, const RgbdTrackingOptions& options)
{
  constexpr Index pairs = 24, apart = 6; // frames
  constexpr double least_turn = 0.02;    // radian: less motion says little
  const DepthRules rules{video.depth_unit, options.nearest, options.farthest};
  std::vector<std::optional<CalibrationPair>> found(std::min(pairs, video.count / 2));
  const auto make = [&](Index k) {
    const Index first = k * video.count / found.size(), second = std::min(first + apart, video.count - 1);
    CalibrationPair pair{makePyramid(video.read(first), rules), makePyramid(video.read(second), rules)};
    RgbdPyramid shape = pair.current;
    for (RgbdLevel& level : shape.levels)
      level.gray = {};
    const RgbdCameras cameras{video.camera, video.camera};
    if (pair.reference.levels.size() < 2 || pair.reference.contrast < 1)
      return;
    const DenseAlignment aligned =
        alignDense(makeReference(pair.reference, cameras), shape, cameras, Eigen::Isometry3d::Identity(), {});
    pair.T_current_reference = aligned.T_reference_current.inverse();
    if (isAligned(aligned) && Eigen::AngleAxisd(pair.T_current_reference.linear()).angle() > least_turn)
      found[k] = std::move(pair);
  };
  parallelFor(found.size(), options.threads, make, 1);
  std::vector<CalibrationPair> kept;
  for (auto& pair : found)
    if (pair)
      kept.push_back(std::move(*pair));
  return kept;
}
} // namespace

RgbdTrackingResult trackRgbd(const RgbdVideo& video, const RgbdTrackingOptions& options, const Progress& progress)
{
  TrackingMap map;
  map.cameras.depth = video.camera;
  map.cameras.color = video.camera;
  if (options.calibrate_color) {
    report(progress, "colour camera", 0.0);
    map.cameras = calibrateColorCamera(calibrationPairs(video, options), map.cameras, options.threads);
    fprintf(stderr, "colour f %.1f c %.1f %.1f t %.4f %.4f\n", map.cameras.color.fx, map.cameras.color.cx, map.cameras.color.cy, map.cameras.color_from_depth.x(), map.cameras.color_from_depth.y());
  }
  map.frames.resize(video.count);
  Odometry odometry(map, options.threads);
  forEachFrame(video, options, progress,
               [&](Index frame, RgbdPyramid pyramid) { odometry.add(frame, std::move(pyramid)); });
  require(!map.key_frames.empty(), "");
  RgbdTrackingResult result;
  result.loop_closures = closeLoops(map, options.threads, subProgress(progress, 0.7, 0.8));
  IsometryVector poses = solvePoses(map, chainPoses(map));
  for (int round = 0; round < options.refinement_rounds; ++round)
    refineMap(map, poses, options.threads, subProgress(progress, 0.8 + 0.2 * round / options.refinement_rounds, 0.8 + 0.2 * (round + 1) / options.refinement_rounds));
  const Submaps submaps = findSubmaps(map);
  const Index largest = std::max_element(submaps.frames.begin(), submaps.frames.end()) - submaps.frames.begin();
  for (const FramePlace& place : map.frames) {
    const bool placed = place.key_frame >= 0 && submaps.of[place.key_frame] == largest;
    result.poses.push_back(placed ? Pose((poses[place.key_frame] * place.T_key_frame).matrix()) : Pose());
  }
  for (const KeyFrame& key : map.key_frames)
    result.key_frames.push_back(key.frame);
  return result;
}
} // namespace fresco
