// SPDX-License-Identifier: BSD-3-Clause
#include "support/args.h"
#include "support/ranks.h"
#include "support/tool.h"
#include <fresco/model/build_model.h>
namespace {
void print(const fresco::ModelReport& report, bool quiet)
{
  for (const fresco::ModelStage& stage : report.stages) {
    fresco::inform(quiet, fresco::stageSummary(stage));
    for (const std::string& warning : stage.warnings)
      fresco::inform(quiet, "warning: " + warning);
  }
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
        "INPUT is a folder of scans (scans/*.pcd), alone, with panoramas named as the scans (panoramas/*.jpg) or\n"
        "with photographs (cameras/ as COLMAP model, images/, and poses.txt, of which only the first pose is used\n"
        "unless -use_poses is given: it ties the scans to the photographs; cameras with points3D may have a frame and "
        "scale\n"
        "of their own; without cameras/ the program colmap finds them), an RGB-D folder (camera-intrinsics.txt, "
        "frame-*.{color.jpg,depth.png,pose.txt}), or a file\n"
        "of scans (.e57 with the pictures inside, .ptx).\n"
        "Writes model.obj/.mtl/.png, model.glb, mesh.ply, poses.txt, snapshots/*.png, report.html and\n"
        "report.json to OUT_DIR; OUT_DIR/work holds what -resume needs.");
    args.flag("use_poses", options.use_poses,
              "take the poses of the scans (poses.txt) or of RGB-D frames as they are: neither found nor refined");
    args.flag("poses", options.use_poses, "the same as -use_poses");
    args.flag("resume", options.resume, "go on after the last stage that an earlier run into OUT_DIR finished");
    args.option("cell", options.cell,
                "finest cell of the surface reconstruction, metres; 0 = 0.02 for scans, 3 pixels at the median depth "
                "for RGB-D");
    args.option("fuse", options.fuse, "RGB-D: cell in which the frames are fused, metres; 0 = as -cell");
    args.option("bilateral", options.bilateral, "rounds of bilateral smoothing of the normals of scans, >= 0");
    args.option(
        "trim_levels", options.trim_levels,
        "surface that no scan saw is cut off, but gaps of 4 x 4 cells so many octree levels coarser stay closed; of "
        "RGB-D what data sustain so many levels less than elsewhere is cut, at most 0.75; 0 = all stays closed");
    args.flag("no_optimize", options.optimize,
              "leave the vertices where the reconstruction puts them: rounded edges; always so for RGB-D", false);
    args.option("texel", options.texel, "side of a texel, metres; 0 = as fine as photographs, panoramas or points");
    args.option(
        "tile_faces", options.tile_faces,
        "most faces that are textured at a time, >= 0: a mesh of more gets pictures for each of its tiles; 0 = all, or "
        "as many as memory holds");
    args.option("atlas", options.atlas,
                "largest side of a picture of the texture, 128..16384 pixels; a larger texture has several; 0 = 8192");
    args.option("quality", options.quality, "JPEG quality of the texture's pictures, 1..100; 0 = PNG, without loss");
    args.option(
        "panorama_direction", options.panorama_direction,
        "where the middle of a panorama looks: from the x axis of its scan counter-clockwise, degrees, -360..360");
    args.flag("panorama_mirrored", options.panorama_mirrored,
              "panoramas go around counter-clockwise from left to right");
    args.size("size", options.width, options.height, "size of the pictures, pixels");
    common.declare(args);
    const auto words = args.parse(argc, argv, 2);
    if (options.width < 160 || options.height < 120)
      throw fresco::UsageError("option -size: pictures of less than 160x120 pixels are too small");
    for (const char* part : {"", "/scans", "/panoramas", "/images", "/cameras"})
      fresco::requireDistinct({words[1]}, {words[0] + part});
    options.threads = common.threads;
    common.quiet |= ranks.rank() > 0;
    fresco::inform(common.quiet, "input: " + fresco::describeInput(words[0]));
    print(fresco::buildModel({words[0], words[1]}, options, fresco::printProgress(common.quiet), ranks), common.quiet);
  });
}
