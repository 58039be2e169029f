// SPDX-License-Identifier: BSD-3-Clause
#include "compare_report.h"
#include "support/tool.h"
#include <fresco/io/file.h>
#include <fresco/io/formats.h>
#include <fresco/io/json_text.h>
#include <fresco/io/mesh_io.h>
#include <fresco/surface/core/error_colors.h>
#include <iostream>
namespace {
using namespace fresco;

struct Options {
  MeshDistanceOptions distance; // its defaults are the tool's defaults
  CommonOptions common;
  std::string json, colored;
  float largest = 0.f;
  int seed = MeshDistanceOptions{}.seed;
  std::string mesh, reference;
};

Options parse(int argc, char** argv)
{
  Options options;
  Args args(
      "fresco_compare MESH REFERENCE [options]",
      "Distance between two meshes (" + readableExtensions(FileKind::mesh) +
          "): max, mean and RMS over the vertices of one of the exact distance\n"
          "to the surface of the other, both ways and symmetric (the larger), absolute and in % of the diagonal of "
          "the\n"
          "reference's bounding box; angles between normals; topology. Vertices that no face names do not count.");
  args.option("json", options.json, "file for all these numbers");
  args.option("colored", options.colored,
              "mesh file (PLY) for MESH coloured by error: red = 0, green, blue = large; the distances are its field "
              "\"distance\"");
  args.option("largest", options.largest,
              "distance that is blue, in the unit of the meshes; 0 = the largest that occurs");
  args.option("samples", options.distance.samples,
              "also measure this many area-uniform surface samples of each mesh; 0 = vertices only");
  args.option("normal_samples", options.distance.normal_samples,
              "samples of each mesh for the angles between normals, unless -samples is given; 0 = no angles");
  args.option("seed", options.seed, "of the samples, >= 0");
  args.flag("vertices", options.distance.vertex_to_vertex,
            "distance from vertex to nearest vertex instead of to the surface; meshes without faces are allowed");
  options.common.declare(args);
  args.note("Example: fresco_compare model.ply truth.ply -samples 500000 -json errors.json -colored errors.ply");
  const std::vector<std::string> files = args.parse(argc, argv, 2);
  options.mesh = files[0];
  options.reference = files[1];
  requireDistinct({options.json, options.colored}, {options.mesh, options.reference});
  options.distance.threads = options.common.threads;
  if (options.seed < 0 || options.largest < 0.f || options.common.threads < 0)
    throw UsageError("-seed, -largest and -threads want a value of 0 or more");
  if (options.distance.samples < 0 || options.distance.normal_samples < 0)
    throw UsageError("-samples and -normal_samples want a value of 0 or more");
  if (!options.colored.empty() && extension(options.colored) != ".ply")
    throw UsageError("-colored writes PLY, not '" + options.colored + "'");
  options.distance.seed = options.seed;
  return options;
}

TriangleMesh read(const std::string& path, bool need_faces)
{
  TriangleMesh mesh = readMesh(path);
  requireMeasurable(mesh, path, need_faces);
  return mesh;
}

void writeColored(const Options& options, TriangleMesh mesh, const MeshDistanceResult& result)
{
  const float largest = result.vertices.to_reference.max;
  mesh.colors = errorColors(result.vertex_distances, options.largest > 0.f ? options.largest : largest);
  mesh.fields["distance"] = result.vertex_distances;
  writeMesh(options.colored, mesh);
}

void run(const Options& options)
{
  const bool need_faces = !options.distance.vertex_to_vertex;
  const Progress progress = printProgress(options.common.quiet);
  report(progress, "reading", 0.0);
  const TriangleMesh mesh = read(options.mesh, need_faces), reference = read(options.reference, need_faces);
  const Comparison comparison{options.mesh,
                              options.reference,
                              mesh.vertexCount(),
                              mesh.faceCount(),
                              reference.vertexCount(),
                              reference.faceCount(),
                              options.distance,
                              measureMeshDistance(mesh, reference, options.distance, subProgress(progress, 0.3, 1.0))};
  writeOutputs([&] {
    if (!options.json.empty())
      writeFile(options.json, jsonText(comparisonJson(comparison), 1));
    if (!options.colored.empty())
      writeColored(options, mesh, comparison.result);
  });
  std::cout << comparisonText(comparison) << std::flush;
}
} // namespace

int main(int argc, char** argv)
{
  return fresco::runTool("fresco_compare", [&] { run(parse(argc, argv)); });
}
