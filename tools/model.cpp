// SPDX-License-Identifier: BSD-3-Clause
#include "support/args.h"
#include "support/ranks.h"
#include "support/scan_option.h"
#include "support/tool.h"
#include <fresco/io/file.h>
#include <fresco/model/build_model.h>
#include <iostream>
namespace {
using fresco::Range;

void print(const fresco::ModelReport& report, bool quiet)
{
  for (const fresco::ModelStage& stage : report.stages) {
    fresco::inform(quiet, fresco::stageSummary(stage));
    for (const std::string& warning : stage.warnings)
      fresco::inform(quiet, "warning: " + warning);
  }
}

void print(const fresco::ModelPlan& plan, bool quiet, bool dry_run)
{
  const auto say = [&](const std::string& line) {
    if (dry_run)
      std::cout << fresco::oneLine(line) << "\n"; // it is what was asked for
    else
      fresco::inform(quiet, line);
  };
  say("input: " + plan.input);
  for (const std::string& line : plan.found)
    say("  " + line);
  if (dry_run)
    for (const std::string& warning : plan.warnings)
      say("warning: " + warning);
  say((dry_run ? "would do: " : "to do: ") + fresco::planSummary(plan));
}

/// @throws UsageError
void check(const fresco::ModelOptions& options, const std::vector<std::string>& folders)
{
  if (options.width < 160 || options.height < 120)
    throw fresco::UsageError("option -size: pictures of less than 160x120 pixels are too small");
  for (const char* part : {"", "/scans", "/panoramas", "/images", "/cameras"})
    fresco::requireDistinct({folders[1]}, {folders[0] + part});
}

/// Options of what is made before the texture.
void declareSurface(fresco::Args& args, fresco::ModelOptions& options)
{
  args.option("cell", options.cell, Range::above(0).zero("0.02 for scans, 3 pixels at the median depth for RGB-D"),
              "finest cell of the surface reconstruction, metres");
  args.option("fuse", options.fuse, Range::above(0).zero("as -cell"),
              "RGB-D: cell in which the frames are fused, metres");
  args.option("bilateral", options.bilateral, Range::atLeast(0),
              "rounds of bilateral smoothing of the normals of scans");
  args.option("trim_levels", options.trim_levels, Range::above(0).zero("all stays closed"),
              "surface that no scan saw is cut off, but gaps of 4 x 4 cells so many octree levels coarser stay "
              "closed; of RGB-D what data sustain so many levels less than elsewhere is cut, at most 0.75");
  args.flag("no_optimize", options.optimize,
            "leave the vertices where the reconstruction puts them: rounded edges; always so for RGB-D", false);
}

/// Options of the textured models and the pictures.
void declareOutputs(fresco::Args& args, fresco::ModelOptions& options)
{
  args.option("texel", options.texel, Range::above(0).zero("as fine as photographs, panoramas or points"),
              "side of a texel, metres");
  args.option("tile_faces", options.tile_faces, Range::atLeast(1).zero("all, or as many as memory holds"),
              "most faces that are textured at a time: a mesh of more gets pictures for each of its tiles");
  args.option("atlas", options.atlas, Range::within(128, 16384).zero("8192"),
              "largest side of a picture of the texture, pixels; a larger texture has several");
  args.option("faces", options.faces, Range::atLeast(1), "most faces of model.glb, the light model");
  args.flag("lod", options.lod,
            "also write OUT_DIR/tiles/tileset.json: the full model as 3D Tiles 1.1, of which a browser loads what it "
            "shows");
  args.flag("compress", options.compress, "compress model.glb by EXT_meshopt_compression, which not all programs read");
  args.option("quality", options.quality, Range::within(1, 100).zero("PNG, without loss"),
              "JPEG quality of the texture's pictures");
  args.option("panorama_direction", options.panorama_direction, Range::within(-360, 360),
              "where the middle of a panorama looks: from the x axis of its scan counter-clockwise, degrees");
  args.flag("panorama_mirrored", options.panorama_mirrored, "panoramas go around counter-clockwise from left to right");
  args.size("size", options.width, options.height, Range::within(120, 65536), "size of the pictures, pixels");
}
} // namespace

int main(int argc, char** argv)
{
  return fresco::runRanks("fresco_model", argc, argv, [&](const std::string& program, fresco::Exchange& ranks) {
    fresco::ModelOptions options; // its defaults are the tool's defaults
    fresco::CommonOptions common;
    fresco::Args args(
        program + " INPUT OUT_DIR [options]",
        "Makes a textured model of a room: points and normals, poses, surface, texture, pictures, report.\n"
        "INPUT is a folder or file in any of the layouts of docs/inputs.md: scans, one cloud of points, RGB-D frames "
        "of\n"
        "datasets and phones, a COLMAP project, photographs, a video. -dry_run tells what it is taken for. Of scans "
        "with\n"
        "photographs, poses.txt ties them to each other; only its first pose is used unless -use_poses is given.\n"
        "Writes model.glb (light: fewer faces, with a normal map), model_full.glb, model.obj/.mtl/.png, mesh.ply,\n"
        "poses.txt, snapshots/*.png, report.html and report.json to OUT_DIR; OUT_DIR/work holds what -resume needs.");
    args.flag("use_poses", options.use_poses,
              "take the poses of the scans (poses.txt) or of RGB-D frames as they are: neither found nor refined");
    args.flag("poses", options.use_poses, "the same as -use_poses");
    args.option(
        "hints", options.hints,
        "what is known of the places of scans, a line each: link A B, relative A B POSE, near A X Y [Z] R, choose "
        "A B NUMBER, apart A B, order; OUT_DIR/registration.html shows the lines that help. With -resume pairs of "
        "scans are not searched again");
    bool dry_run = false;
    args.flag("dry_run", dry_run,
              "tell what INPUT is taken for and what would be done, and how long it takes; write nothing");
    args.option("as", options.taken_as,
                "what INPUT is taken for: scans, cloud, rgbd or photographs; empty = what it looks like");
    args.option("depth_unit", options.depth_unit, Range::above(0).zero("as the layout has it"),
                "RGB-D: what a unit of depth images of whole numbers stands for, metres");
    args.option("until", options.until,
                "stop at points (points.ply), surface (surface.ply) or mesh (mesh.ply: edges are sharp, no texture); "
                "-resume goes on from there; empty = the whole model");
    args.flag("resume", options.resume, "go on after the last stage that an earlier run into OUT_DIR finished");
    declareSurface(args, options);
    declareOutputs(args, options);
    fresco::declareColumns(args);
    args.settingsFile("settings",
                      "options from a file: lines \"NAME VALUE\"; OUT_DIR/settings.txt holds those of the last run");
    args.dotted(
        "-STAGE.OPTION VALUE sets an option of a stage's own tool: -reconstruct.depth 10, -texture.refine 0. A stage "
        "or\n"
        "option that is none is answered with those that there are.",
        [&](const std::string& name, const std::string& value) { options.stage_options.emplace_back(name, value); });
    common.declare(args);
    const auto words = args.parse(argc, argv, 2);
    check(options, words);
    options.threads = common.threads;
    common.quiet |= ranks.rank() > 0;
    const fresco::ModelPlan plan = fresco::planModel({words[0], words[1]}, options);
    print(plan, common.quiet, dry_run);
    if (dry_run)
      return;
    print(fresco::buildModel({words[0], words[1]}, options, fresco::printProgress(common.quiet), ranks), common.quiet);
    if (ranks.rank() == 0)
      fresco::writeFile(words[1] + "/settings.txt",
                        "# fresco_model " + words[0] + "\n" +
                            args.settings({"settings", "resume", "dry_run", "quiet", "threads"}));
  });
}
