// SPDX-License-Identifier: BSD-3-Clause
#include "support/tool.h"
#include <algorithm>
#include <filesystem>
#include <fresco/io/formats.h>
#include <fresco/io/listed.h>
#include <fresco/simulation/sensors/dataset.h>
#include <fresco/simulation/sensors/layouts.h>
using namespace fresco;
using namespace fresco::simulation;

namespace {
void declare(Args& args, DatasetOptions& options, int& seed)
{
  args.option("stations", options.stations, Range::within(1, 1000), "laser stations");
  args.option("rooms", options.rooms, Range::within(4, 32),
              "of a storey of the scene office; the seed makes the floor");
  args.option("storeys", options.storeys, Range::within(1, 2),
              "of the scene office; two with a stairwell and stations in it");
  args.option("points", options.laser.points, Range::within(100, 1e8), "laser points per station, about");
  args.flag("turned", options.turned,
            "each scan in a frame turned arbitrarily, as of a scanner that knows no vertical");
  args.option("noise", options.laser.noise, Range::within(0, 1),
              "deviation of the range at 4 m, metres; it grows with range and incidence");
  args.flag("no_veil", options.laser.veil, "thin laser beams: no mixed pixels (veil points) at depth jumps", false);
  args.option("max_range", options.laser.max_range, Range::above(0).zero("30 in rooms, without limit for meshes"),
              "of the laser, metres");
  args.option("seed", seed, Range::atLeast(0), "of all random numbers; same seed, same bytes");
  args.size("images", options.width, options.height, Range::within(16, 20000), "size of the photographs, pixels");
  args.option("views", options.views, Range::within(0, 100000), "photographs");
  args.flag("panoramas", options.panoramas, "a panorama from each station, as panoramas/scan_NN.jpg");
  args.option("panorama_height", options.panorama_height, Range::within(8, 10000),
              "of the panoramas, twice as wide, pixels");
  args.flag("e57", options.survey, "also scans, panoramas and photographs with their poses in one file, survey.e57");
  args.flag("intensity", options.laser.intensity,
            "scans get intensities in place of colours: reflectance times cosine of incidence / range^2");
  args.flag("labels", options.labels,
            "scans get a field label: 0 = of one surface, 1 = of several but within the noise of one, 2 = mixed pixel "
            "(veil point)");
  args.values("no_images", "", "no photographs", [](const auto&) {});
  args.option("exposure", options.exposure_spread, Range::within(0, 0.9),
              "spread of the photographs' brightness; white balance a quarter of it");
  args.option("sensor_noise", options.sensor_noise, Range::within(0, 100), "of the photographs, grey levels of 255");
  args.option("vignetting", options.vignetting, Range::within(0.1, 1),
              "light in the photographs' corners, of that in their middle");
  args.option("response", options.response, Range::within(0, 1).zero("none"),
              "strength of the photographs' S-shaped tone curve");
  args.option("blur", options.blur, Range::within(0, 20), "of the photographs, pixels (deviation)");
  args.option("intruder", options.intruder, Range::atLeast(1).zero("in none"),
              "somebody stands in every Nth photograph");
  args.option("pose_noise", options.pose_noise, Range::within(0, 1),
              "deviation of the written cameras' positions, metres");
  args.option("turn_noise", options.turn_noise, Range::within(0, 10),
              "deviation of the written cameras' directions, degrees");
  args.option("photographed", options.photographed, Range::within(0.05, 1),
              "share of the scene along x that photographs show");
  args.option("sparse", options.sparse, Range::atLeast(0),
              "points in cameras/points3D.txt as structure from motion finds them");
  args.option("sparse_noise", options.sparse_noise, Range::within(0, 1), "deviation of these from the surface, metres");
  args.option("sparse_outliers", options.sparse_outliers, Range::within(0, 1), "share of these that is wrong");
  args.option("own_frame", options.own_frame, Range::atLeast(1).zero("that of poses.txt"),
              "cameras/ gets a frame and a scale (0.01..100) of its own, made by this seed; own_frame.txt tells which");
  args.option("quality", options.jpeg_quality, Range::within(1, 100), "of the JPEG files");
  args.option("rgbd", options.rgbd_frames, Range::within(0, 100000),
              "frames of an RGB-D camera that is carried around, as rgbd/frame-NNNNNN.{color.jpg,depth.png}; "
              "rgbd/poses.txt is the truth");
  args.size("rgbd_size", options.rgbd_width, options.rgbd_height, Range::within(16, 20000),
            "size of these images, pixels");
  args.flag("truth_images", options.truth_images,
            "also photographs without exposure differences and noise, with the tone curve of -response (PNG)");
  args.option("edge", options.max_edge, Range::within(0.02, 10), "longest side of a face of the rooms' truth, metres");
  args.note("SCENE is conference_room, apartment (two rooms and a door), office (rooms at corridors) or a mesh file (" +
            readableExtensions(FileKind::mesh) +
            ").\n"
            "Writes scans/scan_NN.pcd, panoramas/scan_NN.jpg if asked for, images/view_NNN.jpg, cameras/ (COLMAP "
            "text), own_frame.txt, truth.ply, exposures.txt, poses.txt, with -e57 survey.e57, with -rgbd rgbd/.\n"
            "Example: fresco_scan conference_room room -stations 6 -noise 0.003 -images 1280x960");
}
} // namespace

int main(int argc, char** argv)
{
  return runTool("fresco_scan", [&] {
    DatasetOptions options;
    int seed = 1;
    CommonOptions common;
    Args args("fresco_scan SCENE OUT_DIR [options]", "Virtual laser scanner and camera with known truth.");
    declare(args, options, seed);
    std::string layout;
    args.option("layout", layout,
                "writes the same data as another program or device lays it out, instead: " +
                    listed(layoutNames(), 100) + "; some want -panoramas, -sparse, -e57 or -rgbd");
    common.declare(args);
    const auto files = args.parse(argc, argv, 2);
    requireDistinct({files[1] + "/truth.ply"}, {files[0]});
    const std::vector<std::string> layouts = simulation::layoutNames();
    if (!layout.empty() && std::find(layouts.begin(), layouts.end(), layout) == layouts.end())
      throw UsageError("-layout: " + layout + " is none of " + listed(layouts, layouts.size()));
    options.seed = seed;
    options.threads = common.threads;
    if (args.given("no_images"))
      options.views = 0;
    if (layout.empty()) {
      writeDataset(files[0], files[1], options, printProgress(common.quiet));
      return;
    }
    const std::string source = files[1] + "/.source"; // what the layout is made of
    writeDataset(files[0], source, options, printProgress(common.quiet));
    writeLayout(layout, source, files[1]);
    std::filesystem::remove_all(source);
  });
}
