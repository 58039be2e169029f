// SPDX-License-Identifier: BSD-3-Clause
#include "support/tool.h"
#include <algorithm>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/image_io.h>
#include <fresco/io/pose_file.h>
#include <fresco/io/rgbd_folder.h>
#include <fresco/tracking/core/rgbd_tracking.h>
namespace {
using namespace fresco;

struct Request {
  std::string input, folder;
  RgbdTrackingOptions options;
  CommonOptions common;
};

Request parse(int argc, char** argv)
{
  Request request;
  Args args(
      "fresco_track RGBD_DIR -o OUT_DIR [options]",
      "Finds where a hand-held RGB-D camera was at each frame of a video.\n"
      "RGBD_DIR holds camera-intrinsics.txt (3x3, of the depth images) and frame-*.{color.jpg,depth.png}; depths "
      "are 16 bit, millimetres.\n"
      "Writes poses.txt: world from camera, a line a frame in the order of the numbers, `none` where it was lost.");
  args.option("o", request.folder, "folder of the output, created; required");
  args.option("nearest", request.options.nearest, Range::above(0), "depths below are not used, metres");
  args.option("farthest", request.options.farthest, Range::above(0), "depths beyond are not used, metres");
  args.flag("registered", request.options.calibrate_color,
            "colour images are registered to the depth images: do not look for the colour camera's own calibration",
            false);
  args.option("rounds", request.options.refinement_rounds, Range::within(0, 10),
              "alignments of all key frames that overlap");
  request.common.declare(args);
  request.input = args.parse(argc, argv, 1)[0];
  if (request.folder.empty())
    throw UsageError("-o is missing");
  requireDistinct({request.folder}, {request.input});
  request.options.threads = request.common.threads;
  return request;
}

void run(int argc, char** argv)
{
  Request request = parse(argc, argv);
  if (!isRgbdFolder(request.input))
    throw std::runtime_error(request.input + "/camera-intrinsics.txt: no such file");
  const RgbdFolderFiles files = listRgbdFolder(request.input);
  makeFolder(request.folder);
  const FolderLock lock(request.folder, "fresco_track");
  RgbdVideo video;
  video.camera = files.camera;
  video.count = files.frames.size();
  video.read = [&](Index f) { return RgbdImage{readImage(files.frames[f].color), readImage16(files.frames[f].depth)}; };
  for (const RgbdFrameFiles& frame : files.frames)
    request.options.names.push_back(frame.name);
  const RgbdTrackingResult result = trackRgbd(video, request.options, printProgress(request.common.quiet));
  writeOutputs([&] { writePoses(request.folder + "/poses.txt", result.poses); });
  for (const std::string& warning : result.warnings)
    inform(request.common.quiet, "warning: " + warning);
  const auto placed =
      std::count_if(result.poses.begin(), result.poses.end(), [](const Pose& p) { return p.has_value(); });
  inform(request.common.quiet, concat(placed, " of ", video.count, " frames placed, ", result.key_frames.size(),
                                      " key frames, ", result.loop_closures, " loop closures"));
}
} // namespace

int main(int argc, char** argv)
{
  return runTool("fresco_track", [&] { run(argc, argv); });
}
