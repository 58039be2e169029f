// SPDX-License-Identifier: BSD-3-Clause
#include "stages/stages.h"
#include <algorithm>
#include <fresco/core/require.h>
#include <fresco/io/image_io.h>
#include <fresco/io/pose_file.h>
#include <fresco/tracking/core/rgbd_tracking.h>
namespace fresco::model {
std::vector<RgbdFrame> placedFrames(const Job& job)
{
  const RgbdFolder& rgbd = *job.input.rgbd;
  if (rgbd.has_poses)
    return rgbd.frames;
  const std::vector<Pose> poses = readPoses(job.files.poses);
  std::vector<RgbdFrame> placed;
  for (std::size_t f = 0; f < rgbd.frames.size(); ++f)
    if (poses.at(f)) {
      placed.push_back(rgbd.frames[f]);
      placed.back().T_world_camera = Eigen::Isometry3d(*poses[f]);
    }
  return placed;
}

std::vector<Pose> trackFrames(const Job& job, Figures& figures, const Progress& progress)
{
  const RgbdFolder& rgbd = *job.input.rgbd;
  RgbdVideo video;
  video.camera = rgbd.camera;
  video.count = rgbd.frames.size();
  video.depth_unit = rgbd.depth_unit;
  video.read = [&](Index f) { return RgbdImage{readImage(rgbd.frames[f].color), readDepthUnits(rgbd, f)}; };
  RgbdTrackingOptions options = job.stages.tracking;
  for (const RgbdFrame& frame : rgbd.frames)
    options.names.push_back(frame.name);
  const RgbdTrackingResult result = trackRgbd(video, options, progress);
  figures["tracked_frames"] =
      std::count_if(result.poses.begin(), result.poses.end(), [](const Pose& p) { return bool(p); });
  figures["key_frames"] = result.key_frames.size();
  figures["loop_closures"] = result.loop_closures;
  for (const std::string& warning : result.warnings)
    figures["warnings"].push_back(warning);
  return result.poses;
}
} // namespace fresco::model
