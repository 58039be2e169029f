// SPDX-License-Identifier: BSD-3-Clause
#include "color_camera.h"
#include "loop_closure.h"
#include "map_refinement.h"
#include "odometry.h"
#include "video_reader.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel_batches.h>
#include <fresco/core/require.h>
#include <optional>
namespace fresco {
namespace {
using namespace tracking;

void validate(const RgbdVideo& video, const RgbdTrackingOptions& options)
{
  require(video.count > 0 && video.read, "RGB-D tracking: no frames");
  validateCamera(video.camera);
  require(!video.camera.hasDistortion(), "RGB-D tracking: the camera is not a pinhole camera");
  require(video.camera.width >= 32 && video.camera.height >= 24, "RGB-D tracking: images of ", video.camera.width, "x",
          video.camera.height, " pixels are too small");
  require(video.depth_unit > 0 && std::isfinite(video.depth_unit), "RGB-D tracking: depth unit ", video.depth_unit,
          " is not positive");
  require(options.nearest > 0 && options.farthest > options.nearest && std::isfinite(options.farthest),
          "RGB-D tracking: depths from ", options.nearest, " to ", options.farthest, " m");
  require(options.refinement_rounds >= 0 && options.refinement_rounds <= 10,
          "RGB-D tracking: ", options.refinement_rounds, " rounds are not in 0..10");
  require(options.names.empty() || Index(options.names.size()) == video.count, "RGB-D tracking: ", options.names.size(),
          " names for ", video.count, " frames");
  threadCount(options.threads);
}

/// Two frames a moment apart that depth alone aligns and that are turned against each other.
std::optional<CalibrationPair> calibrationPair(const VideoReader& reader, const RgbdCameras& cameras, Index first)
{
  constexpr Index apart = 6;          // frames
  constexpr double least_turn = 0.02; // radian: less motion says little
  CalibrationPair pair{reader(first), reader(std::min(first + apart, reader.count() - 1))};
  if (std::min(pair.reference.levels.size(), pair.current.levels.size()) < 2 ||
      pair.reference.levels[0].gray.data.empty() || pair.current.levels[0].gray.data.empty())
    return {};
  RgbdPyramid shape = pair.current;
  for (RgbdLevel& level : shape.levels)
    level.gray = {};
  AlignmentOptions options;
  options.threads = 1; // pairs run side by side
  const DenseAlignment aligned =
      alignDense(makeReference(pair.reference, cameras), shape, cameras, Eigen::Isometry3d::Identity(), options);
  pair.T_current_reference = aligned.T_reference_current.inverse();
  if (!isAligned(aligned) || Eigen::AngleAxisd(pair.T_current_reference.linear()).angle() < least_turn)
    return {};
  return pair;
}

RgbdCameras findCameras(const VideoReader& reader, const RgbdVideo& video, const RgbdTrackingOptions& options)
{
  constexpr Index pairs = 24; // spread over the video
  const RgbdCameras cameras{video.camera, reader.colorCamera()};
  std::vector<std::optional<CalibrationPair>> found(options.calibrate_color ? std::min(pairs, video.count / 2) : 0);
  parallelFor(
      found.size(), options.threads,
      [&](Index k) { found[k] = calibrationPair(reader, cameras, k * video.count / Index(found.size())); }, 1);
  std::vector<CalibrationPair> kept;
  for (auto& pair : found)
    if (pair)
      kept.push_back(std::move(*pair));
  return calibrateColorCamera(kept, cameras, options.threads);
}

/// Frames are read and prepared side by side, some at a time, and tracked in their order.
/// @return why frames could not be read, empty = they were
std::vector<std::string> trackFrames(TrackingMap& map, const VideoReader& reader, int threads, const Progress& progress)
{
  Odometry odometry(map, threads);
  std::vector<std::string> problems;
  for (Index begin = 0; begin < reader.count(); begin += batch_size) {
    report(progress, "track", double(begin) / reader.count());
    std::vector<RgbdPyramid> pyramids(std::min(batch_size, reader.count() - begin));
    parallelFor(
        pyramids.size(), threads, [&](Index k) { pyramids[k] = reader(begin + k); }, 1);
    for (std::size_t k = 0; k < pyramids.size(); ++k) {
      problems.push_back(pyramids[k].problem);
      odometry.add(begin + k, std::move(pyramids[k]));
    }
  }
  return problems;
}

/// A line for each run of frames without a pose.
std::vector<std::string> warningsOf(const RgbdTrackingResult& result, const VideoReader& reader,
                                    const std::vector<std::string>& problems)
{
  constexpr std::size_t most = 20; // lines: more nobody reads
  std::vector<std::string> lines;
  const Index count = result.poses.size();
  for (Index begin = 0, end; begin < count; begin = end) {
    end = begin + 1;
    if (result.poses[begin])
      continue;
    const auto alike = [&](Index f) {
      return !result.poses[f] && result.submaps[f] == result.submaps[begin] && problems[f].empty() &&
             problems[begin].empty();
    };
    while (end < count && alike(end))
      ++end;
    const std::string which =
        end - begin == 1 ? reader.name(begin)
                         : concat(reader.name(begin), " to ", reader.name(end - 1), " (", end - begin, " frames)");
    if (!problems[begin].empty())
      lines.push_back(problems[begin] + "; the frame is left out");
    else if (result.submaps[begin] < 0)
      lines.push_back(which + ": no pose: hardly any depth");
    else
      lines.push_back(which + ": left out: does not fit to the others: another place, or another video");
  }
  if (lines.size() > most) {
    const std::size_t more = lines.size() - most;
    lines.resize(most);
    lines.push_back(concat("and ", more, " more of the kind"));
  }
  return lines;
}

RgbdTrackingResult resultOf(const TrackingMap& map, const IsometryVector& poses)
{
  RgbdTrackingResult result;
  result.color_camera = map.cameras.color;
  result.color_from_depth = map.cameras.color_from_depth.cast<double>();
  const Submaps submaps = findSubmaps(map);
  const Index largest = std::max_element(submaps.frames.begin(), submaps.frames.end()) - submaps.frames.begin();
  for (const FramePlace& place : map.frames) {
    const Index submap = place.key_frame < 0 ? -1 : submaps.of[place.key_frame];
    result.poses.push_back(submap == largest ? Pose((poses[place.key_frame] * place.T_key_frame).matrix()) : Pose());
    result.submaps.push_back(static_cast<int>(submap < 0 ? -1 : submap == largest ? 0 : submap + (submap < largest)));
  }
  for (const KeyFrame& key : map.key_frames)
    result.key_frames.push_back(key.frame);
  return result;
}
} // namespace

RgbdTrackingResult trackRgbd(const RgbdVideo& video, const RgbdTrackingOptions& options, const Progress& progress)
{
  validate(video, options);
  report(progress, "colour camera", 0.0);
  const VideoReader reader(video, options);
  TrackingMap map;
  map.cameras = findCameras(reader, video, options);
  map.frames.resize(video.count);
  const std::vector<std::string> problems = trackFrames(map, reader, options.threads, subProgress(progress, 0.05, 0.7));
  if (map.key_frames.empty())
    throw std::runtime_error(reader.name(0) + ": no frame has enough depth, nor any after it");
  const Index closures = closeLoops(map, options.threads, subProgress(progress, 0.7, 0.8));
  IsometryVector poses = solvePoses(map, chainPoses(map));
  for (int round = 0; round < options.refinement_rounds; ++round)
    refineMap(map, poses, options.threads,
              subProgress(progress, 0.8 + 0.2 * round / options.refinement_rounds,
                          0.8 + 0.2 * (round + 1) / options.refinement_rounds));
  RgbdTrackingResult result = resultOf(map, poses);
  result.loop_closures = closures;
  result.warnings = warningsOf(result, reader, problems);
  return result;
}
} // namespace fresco
