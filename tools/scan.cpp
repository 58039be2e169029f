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
  args.option("stations", options.stations, "laser stations, 1..1000");
  args.option("rooms", options.rooms, "of a storey of the scene office, 4..32; the seed makes the floor");
  args.option("storeys", options.storeys, "of the scene office, 1..2; two with a stairwell and stations in it");
  args.option("points", options.laser.points, "laser points per station, about, 100..100000000");
  args.flag("turned", options.turned,
            "each scan in a frame turned arbitrarily, as of a scanner that knows no vertical");
  args.option("noise", options.laser.noise,
              "deviation of the range at 4 m, metres, 0..1; it grows with range and incidence");
  args.flag("no_veil", options.laser.veil, "thin laser beams: no mixed pixels (veil points) at depth jumps", false);
  args.option("max_range", options.laser.max_range, "of the laser, metres; 0 = 30 in rooms, without limit for meshes");
  args.option("seed", seed, "of all random numbers; same seed, same bytes; >= 0");
  args.size("images", options.width, options.height, "size of the photographs, pixels, 16..20000 each");
  args.option("views", options.views, "photographs, 0..100000");
  args.flag("panoramas", options.panoramas, "a panorama from each station, as panoramas/scan_NN.jpg");
  args.option("panorama_height", options.panorama_height, "of the panoramas, twice as wide, pixels, 8..10000");
  args.flag("e57", options.survey, "also scans, panoramas and photographs with their poses in one file, survey.e57");
  args.flag("intensity", options.laser.intensity,
            "scans get intensities in place of colours: reflectance times cosine of incidence / range^2");
  args.flag("labels", options.labels,
            "scans get a field label: 0 = of one surface, 1 = of several but within the noise of one, 2 = mixed pixel "
            "(veil point)");
  args.values("no_images", "", "no photographs", [](const auto&) {});
  args.option("exposure", options.exposure_spread,
              "spread of the photographs' brightness, 0..0.9; white balance a quarter of it");
  args.option("sensor_noise", options.sensor_noise, "of the photographs, grey levels of 255, 0..100");
  args.option("vignetting", options.vignetting, "light in the photographs' corners, of that in their middle, 0.1..1");
  args.option("response", options.response, "strength of the photographs' S-shaped tone curve, 0..1; 0 = none");
  args.option("blur", options.blur, "of the photographs, pixels (deviation), 0..20");
  args.option("intruder", options.intruder, "somebody stands in every Nth photograph, >= 0; 0 = in none");
  args.option("pose_noise", options.pose_noise, "deviation of the written cameras' positions, metres, 0..1");
  args.option("turn_noise", options.turn_noise, "deviation of the written cameras' directions, degrees, 0..10");
  args.option("photographed", options.photographed, "share of the scene along x that photographs show, 0.05..1");
  args.option("sparse", options.sparse, "points in cameras/points3D.txt as structure from motion finds them, >= 0");
  args.option("sparse_noise", options.sparse_noise, "deviation of these from the surface, metres, 0..1");
  args.option("sparse_outliers", options.sparse_outliers, "share of these that is wrong, 0..1");
  args.option(
      "own_frame", options.own_frame,
      "cameras/ gets a frame and a scale (0.01..100) of its own, made by this seed; own_frame.txt tells which; 0 "
      "= that of poses.txt");
  args.option("quality", options.jpeg_quality, "of the JPEG files, 1..100");
  args.option(
      "rgbd", options.rgbd_frames,
      "frames of an RGB-D camera that is carried around, 0..100000, as rgbd/frame-NNNNNN.{color.jpg,depth.png}; "
      "rgbd/poses.txt is the truth");
  args.size("rgbd_size", options.rgbd_width, options.rgbd_height, "size of these images, pixels, 16..20000 each");
  args.flag("truth_images", options.truth_images,
            "also photographs without exposure differences and noise, with the tone curve of -response (PNG)");
  args.option("edge", options.max_edge, "longest side of a face of the rooms' truth, metres, 0.02..10");
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
    if (seed < 0)
      throw UsageError("-seed: " + std::to_string(seed) + " is negative");
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
