// SPDX-License-Identifier: BSD-3-Clause
#include "support/scan_option.h"
#include "support/tool.h"
#include <algorithm>
#include <fresco/core/require.h>
#include <fresco/io/camera_files.h>
#include <fresco/io/colmap.h>
#include <fresco/io/file.h>
#include <fresco/io/formats.h>
#include <fresco/io/image_io.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <fresco/texture/core/point_texture.h>
#include <fresco/texture/core/texture_reconstruction.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <memory>
namespace {
using namespace fresco;

struct ToolOptions {
  int keep_out = 0, quality = 0;
  bool no_examples = false;
  std::string cameras_out, points, uv = "new";
  PointTextureOptions from_points;
};

std::vector<TextureView> viewsOf(const CameraSet& set, const std::string& folder)
{
  std::vector<TextureView> views;
  for (const View& view : set.views) {
    TextureView out;
    out.camera = set.cameras[view.camera];
    out.T_camera_world = view.T_camera_world;
    out.path = folder + "/" + view.image;
    out.mask_path = maskFileOf(folder, view.image);
    views.push_back(std::move(out));
  }
  return views;
}

void declare(Args& args, TextureOptions& options, ToolOptions& tool)
{
  args.option("points", tool.points,
              "cloud whose colours, else intensities, the texture is made of; of the options below it takes "
              "-no_exposure, -texel, -atlas and -border");
  args.option("point_width", tool.from_points.width, Range::within(0.3, 10),
              "with -points: deviation of the Gaussian in distances from one point to the next");
  args.option("point_rounds", tool.from_points.rounds, Range::within(0, 20),
              "with -points: corrections by what the points differ from the texture");
  args.flag("no_refine", options.refine, "take the cameras as they are given", false);
  args.flag("no_exposure", options.exposure, "leave exposure and white balance of the photographs as they are", false);
  args.flag("no_consistency", options.consistency, "do not avoid photographs that differ from what most show", false);
  args.flag("no_level", options.level, "leave the steps of colour at seams", false);
  args.flag("no_examples", tool.no_examples, "taken and ignored: unseen parts are always coloured smoothly");
  args.option("blend_width", options.blend_width, Range::within(0, 100),
              "pixels over which one photograph passes into the next at a seam");
  args.option("rounds", options.rounds, Range::within(0, 100),
              "how often texels are corrected by all photographs; not with -no_refine or -no_exposure");
  args.option("keep_out", tool.keep_out, Range::atLeast(1).zero("none"),
              "every Nth photograph (the Nth, 2Nth ...) is aligned with the others but not used, to judge by");
  args.option("cameras_out", tool.cameras_out, "folder for the cameras as used, a COLMAP text model; empty = none");
  args.option("texel", options.texel, Range::above(0).zero("as fine as the photographs show each part"),
              "side of a texel in mesh units");
  args.option("atlas", options.atlas, Range::within(128, 16384).zero("8192"),
              "largest side of an atlas, pixels; a larger texture has several");
  args.option("uv", tool.uv,
              "texture coordinates: new, or keep those of MESH (.obj, .glb) and the sizes of its images");
  args.option("quality", tool.quality, Range::within(1, 100).zero("PNG, without loss"),
              "JPEG quality of the texture's pictures");
  args.option("border", options.border, Range::within(1, 16), "texels around each chart against bleeding");
  args.option("smoothness", options.smoothness, Range::above(0).zero("best view of each face"),
              "how much fewer seams are worth against resolution, in bounding-box diagonals");
  args.option("margin", options.margin, Range::within(0, 100),
              "pixels kept away from the outline of what stands in front");
  args.option("depth_tolerance", options.depth_tolerance, Range::within(0, 0.5),
              "share of the typical distance by which occlusion is forgiven");
  args.option("tile_faces", options.tile_faces, Range::atLeast(1).zero("all, or as many as memory holds"),
              "most faces that are textured at a time: a mesh of more gets atlases for each of its tiles");
  args.option("memory", options.memory, Range::atLeast(1),
              "MB of photographs kept at a time, decoded or as grey copies");
}

/// One camera per view: they may differ after refinement.
CameraSet usedCameras(CameraSet set, const TextureResult& result)
{
  set.cameras.clear();
  for (std::size_t v = 0; v < set.views.size(); ++v) {
    set.cameras.push_back(result.cameras[v].camera);
    set.views[v].camera = static_cast<int>(v);
    set.views[v].T_camera_world = result.cameras[v].T_camera_world;
  }
  return set;
}

/// The pictures beside the model must not replace photographs or other inputs.
void requireOtherFiles(const std::string& out, const std::vector<TextureView>& views, std::vector<std::string> inputs)
{
  const std::string stem = out.substr(0, out.size() - extension(out).size());
  std::vector<std::string> outputs{stem + ".mtl", stem + ".png", stem + ".jpg", maskPath(out, 0, 1)};
  for (std::size_t i = 0; i < 10; ++i) // there are rarely more than two
    outputs.insert(outputs.end(), {concat(stem, '_', i, ".png"), concat(stem, '_', i, ".jpg"), maskPath(out, i, 2)});
  for (const TextureView& view : views) {
    inputs.push_back(view.path);
    if (!view.mask_path.empty())
      inputs.push_back(view.mask_path);
  }
  requireDistinct(outputs, inputs);
}

void requireSurface(const std::string& path, const TriangleMesh& mesh)
{
  try {
    validateMesh(mesh);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
  if (mesh.faceCount() == 0 || !(surfaceArea(mesh) > 0))
    throw std::runtime_error(path + ": has no face of positive area");
}

TriangleMesh readSurface(const std::string& path)
{
  TriangleMesh mesh = readMesh(path);
  requireSurface(path, mesh);
  return mesh;
}

AtlasSink sinkOf(TexturedModelWriter& writer)
{
  return [&](const Image& atlas, const Image& mask) { writer.addAtlas(atlas, mask); };
}

struct MeshFile {
  const std::string& path;
  bool keep_uv;
};

TextureResult reconstruct(const MeshFile& file, const std::vector<TextureView>& views, const TextureOptions& options,
                          const CommonOptions& common, TexturedModelWriter& output)
{
  const auto& [path, keep_uv] = file;
  if (!keep_uv)
    return reconstructTexture(readSurface(path), views, options, printProgress(common.quiet), sinkOf(output));
  const TexturedMesh model = readTextureLayout(path);
  requireSurface(path, model.mesh);
  return reconstructTexture(model, views, options, printProgress(common.quiet));
}

template <typename Result>
void printAtlas(const Result& result, bool quiet)
{
  for (const std::string& warning : result.warnings)
    inform(quiet, "warning: " + warning);
  const std::vector<Image>& atlases = result.model.atlases;
  inform(quiet, format("%td charts in %zu atlas%s of %dx%d, %.0f %% of the texels used, texel %.3g", result.charts,
                       atlases.size(), atlases.size() == 1 ? "" : "es", atlases[0].width, atlases[0].height,
                       100 * result.used, result.texel));
}

/// @param files mesh, output
void textureFromPoints(const std::vector<std::string>& files, const ToolOptions& tool, const TextureOptions& shared,
                       bool quiet)
{
  PointTextureOptions options = tool.from_points;
  options.texel = shared.texel;
  options.atlas = shared.atlas;
  options.border = shared.border;
  options.exposure = shared.exposure;
  options.threads = shared.threads;
  options.tile_faces = shared.tile_faces;
  requireDistinct({files[1]}, {files[0], tool.points});
  TriangleMesh mesh = readSurface(files[0]);
  const PointSet points = readPoints(tool.points);
  if (std::vector<std::string> reasons; lookOf(points, &reasons) == PointLook::none)
    throw std::runtime_error(tool.points + ": " +
                             (reasons.empty() ? "has neither colours nor intensities" : reasons[0]));
  PointTextureResult result;
  writeOutputs([&] {
    TexturedModelWriter output({{files[1], tool.quality}});
    result = reconstructPointTexture(std::move(mesh), points, options, printProgress(quiet), sinkOf(output));
    if (!(result.coverage > 0))
      throw std::runtime_error(tool.points + ": no part of " + files[0] + " is covered with points");
    output.finish(result.model, result.masks);
  });
  inform(quiet, format("%s of %td points, scans: %td, seen %.1f %% of the surface",
                       result.look == PointLook::colors ? "colours" : "intensities", points.size(), result.gains.cols(),
                       100 * result.coverage));
  printAtlas(result, quiet);
}

void printResult(const TextureResult& result, const std::vector<TextureView>& views, bool quiet)
{
  const auto say = [&](const char* pattern, auto... values) { inform(quiet, format(pattern, values...)); };
  say("seen %.1f %% of the surface, by %td of %zu photographs", 100 * result.coverage, result.views_used, views.size());
  if (const auto masked = std::count_if(views.begin(), views.end(), [](const auto& v) { return !v.mask_path.empty(); }))
    say("masks of %td photographs are used", masked);
  printAtlas(result, quiet);
  if (result.disagreement_before > 0 && result.refined)
    say("photographs disagree by %.2f pixels, %.2f with the cameras as given", result.disagreement_after,
        result.disagreement_before);
  else if (result.disagreement_before > 0)
    say("photographs disagree by %.2f pixels; the cameras are left as given", result.disagreement_before);
  for (const auto& [phase, seconds] : result.seconds)
    say("  %-16s %7.2f s", phase.c_str(), seconds);
}

/// What one thread freed serves the others: an arena for each holds 40 MB more of 700, and no time is gained by it.
void shareFreedMemory()
{
#ifdef __GLIBC__
  mallopt(M_ARENA_MAX, 1);
#endif
}

void run(int argc, char** argv)
{
  shareFreedMemory();
  TextureOptions options;
  ToolOptions tool;
  CommonOptions common;
  Args args("fresco_texture MESH CAMERAS IMAGES_DIR OUT [options], or MESH -points CLOUD OUT [options]",
            "Textures a mesh from calibrated photographs, or from the points it was made of. MESH: " +
                readableExtensions(FileKind::mesh) + ".\nCAMERAS: " + cameraFormats() +
                ".\n"
                "IMAGES_DIR: the photographs it names; masks/NAME.png in it or beside it is white where NAME.jpg is to "
                "be used.\nOUT: .obj (with .mtl and .png beside it), .ply (with .png) or .glb. Beside it "
                "NAME_mask.png:\n"
                "white where no photograph saw the surface, or no point lies on it, and the colour is inpainted.");
  declare(args, options, tool);
  declareColumns(args);
  common.declare(args);
  args.note("Example: fresco_texture mesh.ply scan/cameras scan/images model.glb");
  const std::vector<std::string> files = args.parse(argc, argv, 2, 4);
  if (files.size() != (tool.points.empty() ? 4 : 2))
    throw UsageError(concat("got ", files.size(), " file arguments; wanted: ",
                            tool.points.empty() ? "MESH CAMERAS IMAGES_DIR OUT" : "MESH OUT beside -points"));
  const std::string out = files.back();
  if (extension(out) != ".obj" && extension(out) != ".glb")
    throw UsageError(out + ": the output's extension must be .obj or .glb");
  if (tool.uv == "keep" && options.tile_faces > 0)
    throw UsageError("-uv keep does not go with -tile_faces");
  if (tool.uv != "new" && (tool.uv != "keep" || options.texel > 0 || !tool.points.empty()))
    throw UsageError("-uv is new or keep, which goes with neither -texel nor -points");
  options.threads = common.threads;
  if (!tool.points.empty())
    return textureFromPoints(files, tool, options, common.quiet);
  requireDistinct({out}, {files[0]}); // what else it is made of is known when it has been read
  const bool keep_uv = tool.uv == "keep";
  const CameraSet set = readCameraFile(files[1], files[2]).set;
  if (!tool.cameras_out.empty())
    requireColmapCameras(set);
  std::vector<TextureView> views = viewsOf(set, files[2]);
  requireOtherFiles(out, views, keep_uv ? filesNamedBy(files[0]) : std::vector<std::string>());
  for (std::size_t v = 0; v < views.size() && tool.keep_out > 0; ++v)
    views[v].paint = (v + 1) % static_cast<std::size_t>(tool.keep_out) != 0;
  TextureResult result;
  writeOutputs([&] {
    TexturedModelWriter output({{out, tool.quality}});
    result = reconstruct({files[0], keep_uv}, views, options, common, output);
    if (!(result.coverage > 0))
      throw std::runtime_error(
          concat(files[1], ": none of the ", views.size(), " photographs sees any part of ", files[0]));
    output.finish(result.model, result.masks);
    if (!tool.cameras_out.empty())
      writeColmap(tool.cameras_out, usedCameras(set, result));
  });
  printResult(result, views, common.quiet);
}
} // namespace

int main(int argc, char** argv)
{
  return fresco::runTool("fresco_texture", [&] { run(argc, argv); });
}
