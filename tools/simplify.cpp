// SPDX-License-Identifier: BSD-3-Clause
#include "support/tool.h"
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/deliverables/core/detail_baking.h>
#include <fresco/deliverables/core/model_file.h>
#include <fresco/deliverables/core/simplification.h>
#include <fresco/deliverables/core/tileset.h>
#include <fresco/io/file.h>
#include <fresco/io/formats.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/pose_file.h>
namespace {
using namespace fresco;

struct SimplifyOptions {
  int faces = 0, atlas = LightModelOptions().atlas, atlases = LightModelOptions().atlases, quality = 0;
  double error = 0, texel = 0;
  bool compress = false;
  std::string full, to_world;

  void declare(Args& args)
  {
    args.option("faces", faces, Range::atLeast(1).zero("as few as -error allows"),
                "faces that are to be left, or most of a tile");
    args.option("error", error, Range::above(0).zero("any"),
                "most that a vertex may be off the surface it stands for (RMS), mesh units");
    args.option("from", full,
                "full model whose colours and normals are baked into a new atlas with a normal map; OUT is .glb");
    args.option("texel", texel, Range::above(0).zero("that of the full model"),
                "with -from: side of a texel, mesh units");
    args.option("atlas", atlas, Range::within(128, 16384), "with -from: side of an atlas, pixels");
    args.option("atlases", atlases, Range::atLeast(1),
                "with -from: most atlases; texels are made larger until they suffice");
    args.option("quality", quality, Range::within(1, 100).zero("90 with -from, else PNG without loss"),
                "JPEG quality of the pictures");
    args.flag("compress", compress, "compress OUT.glb by EXT_meshopt_compression, which not all programs read");
    args.option("to_world", to_world,
                "file of 16 numbers, rows of the matrix that takes the model into the world: kept in the node of a "
                ".glb, or in a tileset.json");
  }

  static bool isTileset(const std::string& path) { return std::filesystem::path(path).filename() == "tileset.json"; }

  /// @throws UsageError
  void validate(const std::vector<std::string>& files) const
  {
    const bool glb = extension(files[1]) == ".glb", tiles = isTileset(files[1]);
    if (tiles && (error > 0 || !full.empty() || compress || faces == 0))
      throw UsageError(files[1] + ": tiles take -faces and neither -error, -from nor -compress");
    if (faces == 0 && error == 0 && full.empty())
      throw UsageError("-faces above 0, -error or -from is needed");
    if (!glb && !tiles && (!full.empty() || !to_world.empty() || compress))
      throw UsageError(files[1] + ": the output's extension must be .glb with -from, -to_world and -compress");
    if (!glb && !tiles && !isWritable(files[1], FileKind::mesh) && !isWritable(files[1], FileKind::textured_mesh))
      throw UsageError(files[1] + ": the output's extension must be " + writableExtensions(FileKind::mesh) + ", or " +
                       writableExtensions(FileKind::textured_mesh));
    requireDistinct({files[1]}, {files[0], full, to_world});
  }
};

GltfOptions gltfOptions(const SimplifyOptions& options)
{
  GltfOptions gltf;
  gltf.jpeg_quality = options.quality > 0 || options.full.empty() ? options.quality : 90;
  gltf.compact = true;
  gltf.compress = options.compress;
  if (!options.to_world.empty())
    gltf.T_world_model = readTransform(options.to_world);
  return gltf;
}

/// Says where what was asked for was not possible.
void informOfBounds(const SimplificationFigures& figures, Index before, Index after, const SimplifyOptions& options)
{
  const auto said = [&] { return concat(before, " faces became ", after); };
  if (options.faces >= before)
    return inform(false, concat("warning: the model has ", before, " faces only, so they stay"));
  if (figures.exhausted)
    inform(false, concat("warning: ", said(), ": fewer would ", options.error > 0 ? "exceed the error, " : "",
                         "make holes, flipped faces or slivers"));
}

TexturedMesh simplified(TexturedMesh model, const SimplifyOptions& options, const CommonOptions& common)
{
  const Index before = model.mesh.faceCount();
  SimplificationFigures figures;
  model = simplifyModel(std::move(model), {options.faces, options.error, common.threads}, &figures,
                        printProgress(common.quiet));
  if (!common.quiet)
    informOfBounds(figures, before, model.mesh.faceCount(), options);
  inform(common.quiet, concat(model.mesh.faceCount(), " faces of ", before, ", error ", format("%.3g", figures.error)));
  return model;
}

/// The model of fewer faces in a new atlas with what the full one shows.
/// @param gltf is told whether it is to be lit
GltfModel baked(TexturedMesh model, const SimplifyOptions& options, const CommonOptions& common, GltfOptions& gltf)
{
  if (options.faces > 0 || options.error > 0) {
    model.texcoord_faces.resize(3, 0); // its seams are of no account
    model = simplified(std::move(model), options, common);
  }
  const TexturedMesh full = readModel(options.full).model;
  gltf.lit = !isColored(full);
  LightModelOptions light;
  light.texel = options.texel;
  light.atlas = options.atlas;
  light.atlases = options.atlases;
  light.threads = common.threads;
  return bakeLightModel(std::move(model.mesh), full, light, printProgress(common.quiet));
}

void writeTiles(TexturedMesh model, const std::string& path, const SimplifyOptions& options,
                const CommonOptions& common)
{
  TilesetOptions tiles;
  tiles.faces = options.faces;
  tiles.texel = options.texel;
  tiles.jpeg_quality = options.quality > 0 ? options.quality : tiles.jpeg_quality;
  tiles.T_world_model = gltfOptions(options).T_world_model;
  tiles.threads = common.threads;
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  writeOutputs([&] {
    const auto written =
        writeTileset(folder.empty() ? "." : folder.string(), std::move(model), tiles, printProgress(common.quiet));
    inform(common.quiet, concat(written.size(), " tiles, the first of ", written[0].faces, " faces"));
  });
}

void run(int argc, char** argv)
{
  SimplifyOptions options;
  CommonOptions common;
  Args args("fresco_simplify MODEL OUT -faces N | -error M | -from FULL [options]",
            "Makes a mesh or a textured model lighter: fewer faces, the same borders, creases and texture "
            "seams.\nMODEL, FULL: " +
                readableExtensions(FileKind::mesh) + ", or textured " + readableExtensions(FileKind::textured_mesh) +
                ".\nOUT: " + writableExtensions(FileKind::mesh) + ", or textured " +
                writableExtensions(FileKind::textured_mesh) +
                ",\nor FOLDER/tileset.json: 3D Tiles 1.1 of a large model, which a browser loads in parts.");
  options.declare(args);
  common.declare(args);
  args.note("Example: fresco_simplify model_full.glb light.glb -faces 100000 -from model_full.glb");
  const std::vector<std::string> files = args.parse(argc, argv, 2);
  options.validate(files);
  GltfOptions gltf = gltfOptions(options);
  GltfModel model = readModel(files[0]);
  if (SimplifyOptions::isTileset(files[1]))
    return writeTiles(std::move(model.model), files[1], options, common);
  if (options.full.empty())
    model.model = simplified(std::move(model.model), options, common);
  else
    model = baked(std::move(model.model), options, common, gltf);
  writeOutputs([&] { writeModel(files[1], std::move(model), gltf); });
}
} // namespace

int main(int argc, char** argv)
{
  return fresco::runTool("fresco_simplify", [&] { run(argc, argv); });
}
