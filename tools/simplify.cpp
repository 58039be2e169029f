// SPDX-License-Identifier: BSD-3-Clause
#include "support/tool.h"
#include <fresco/core/require.h>
#include <fresco/deliverables/core/model_file.h>
#include <fresco/deliverables/core/simplification.h>
#include <fresco/io/file.h>
#include <fresco/io/formats.h>
#include <fresco/io/mesh_io.h>
namespace {
using namespace fresco;

/// Says where what was asked for was not possible.
void warnOfBounds(const SimplificationFigures& figures, Index before, Index after, Index wanted)
{
  if (wanted >= before)
    inform(false, concat("warning: the model has ", before, " faces only, so they stay"));
  else if (figures.exhausted)
    inform(false, concat("warning: ", before, " faces became ", after,
                         ": fewer would break a bound, make holes, flipped faces or slivers"));
}

void run(int argc, char** argv)
{
  int faces = 0, quality = 0;
  SimplificationOptions options;
  CommonOptions common;
  Args args(
      "fresco_simplify MODEL OUT -faces N | -error M [options]",
      "Makes a mesh or a textured model lighter: fewer faces, the same borders, creases and texture seams.\nMODEL: " +
          readableExtensions(FileKind::mesh) + ", or textured " + readableExtensions(FileKind::textured_mesh) +
          ".\nOUT: " + writableExtensions(FileKind::mesh) + ", or textured " +
          writableExtensions(FileKind::textured_mesh) + ".");
  args.option("faces", faces, "faces that are to be left, at least 1; 0 = as few as -error allows");
  args.option("error", options.error,
              "most that a vertex may be off the surface it stands for (RMS), mesh units, >= 0; 0 = any");
  args.option("quality", quality, "JPEG quality of a texture's pictures, 1..100; 0 = PNG, without loss");
  common.declare(args);
  args.note("Example: fresco_simplify model.glb light.glb -faces 100000");
  const std::vector<std::string> files = args.parse(argc, argv, 2);
  options.faces = faces;
  options.threads = common.threads;
  if (faces == 0 && options.error == 0)
    throw UsageError("one of -faces and -error is needed");
  if (!isWritable(files[1], FileKind::mesh) && !isWritable(files[1], FileKind::textured_mesh))
    throw UsageError(files[1] + ": the output's extension must be " + writableExtensions(FileKind::mesh) + ", or " +
                     writableExtensions(FileKind::textured_mesh));
  requireDistinct({files[1]}, {files[0]});
  TexturedMesh model = readModel(files[0]);
  const Index before = model.mesh.faceCount();
  SimplificationFigures figures;
  model = simplifyModel(std::move(model), options, &figures, printProgress(common.quiet));
  const Index after = model.mesh.faceCount();
  writeOutputs([&] { writeModel(files[1], std::move(model), quality); });
  if (!common.quiet)
    warnOfBounds(figures, before, after, options.faces);
  inform(common.quiet, concat(after, " faces of ", before, ", error ", format("%.3g", figures.error)));
}
} // namespace

int main(int argc, char** argv)
{
  return fresco::runTool("fresco_simplify", [&] { run(argc, argv); });
}
