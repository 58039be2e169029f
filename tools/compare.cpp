// SPDX-License-Identifier: BSD-3-Clause
#include "support/tool.h"
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/formats.h>
#include <fresco/io/json_text.h>
#include <fresco/io/mesh_io.h>
#include <fresco/surface/core/error_colors.h>
#include <fresco/surface/core/mesh_distance.h>
#include <iostream>
#include <nlohmann/json.hpp>
namespace {
using namespace fresco;
using Json = nlohmann::json;

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
          "to the surface of the other, both ways and symmetric (the larger), absolute and in % of the diagonal "
          "of the\nreference's bounding box; angles between normals; topology. Vertices that no face names do not "
          "count.");
  args.option("json", options.json, "file for all these numbers");
  args.option("colored", options.colored,
              "mesh file (PLY) for MESH coloured by error: red = 0, green, blue = large; the distances are its field "
              "\"distance\"");
  args.option("largest", options.largest, Range::above(0).zero("the largest that occurs"),
              "distance that is blue, in the unit of the meshes");
  args.option("samples", options.distance.samples, Range::atLeast(1).zero("vertices only"),
              "also measure this many area-uniform surface samples of each mesh");
  args.option("normal_samples", options.distance.normal_samples, Range::atLeast(1).zero("no angles"),
              "samples of each mesh for the angles between normals, unless -samples is given");
  args.option("seed", options.seed, Range::atLeast(0), "of the samples");
  args.flag("vertices", options.distance.vertex_to_vertex,
            "distance from vertex to nearest vertex instead of to the surface; meshes without faces are allowed");
  options.common.declare(args);
  args.note("Example: fresco_compare model.ply truth.ply -samples 500000 -json errors.json -colored errors.ply");
  const std::vector<std::string> files = args.parse(argc, argv, 2);
  options.mesh = files[0];
  options.reference = files[1];
  requireDistinct({options.json, options.colored}, {options.mesh, options.reference});
  options.distance.threads = options.common.threads;
  if (!options.colored.empty() && extension(options.colored) != ".ply")
    throw UsageError("-colored writes PLY, not '" + options.colored + "'");
  options.distance.seed = options.seed;
  return options;
}

/// What was compared with what.
struct Comparison {
  const Options& options;
  const TriangleMesh &mesh, &reference;
  MeshDistanceResult result;
};

std::string distanceLine(const char* label, const DistanceStatistics& d, double diagonal)
{
  const double percent = 100.0 / diagonal;
  return format("%-20s %11.6g %11.6g %11.6g  %10.6g %10.6g %10.6g\n", label, d.max, d.mean, d.rms, percent * d.max,
                percent * d.mean, percent * d.rms);
}

std::string distanceLines(const std::string& title, const TwoSidedDistance& distance, double diagonal)
{
  return format("%-20s %11s %11s %11s  %10s %10s %10s\n", title.c_str(), "max", "mean", "RMS", "max", "mean", "RMS") +
         distanceLine("  mesh to reference", distance.to_reference, diagonal) +
         distanceLine("  reference to mesh", distance.from_reference, diagonal) +
         distanceLine("  symmetric", distance.symmetric, diagonal);
}

std::string normalLine(const char* label, const NormalDeviation& n)
{
  return format("%-20s %11.4f %11.4f %11.4f  %10.4f\n", label, n.mean, n.median, n.percentile95,
                100.0 * n.share_above_20);
}

std::string topologyLine(const char* label, const TriangleMesh& mesh, const MeshTopology& t)
{
  return concat(format("%-12s", label), " V ", mesh.vertexCount(), "  F ", mesh.faceCount(), "  boundary edges ",
                t.boundary_edges, "  non-manifold edges ", t.nonmanifold_edges, "  components ", t.components,
                "  watertight ", t.watertight ? "yes" : "no", "\n");
}

Json distanceJson(const DistanceStatistics& d, double diagonal)
{
  const double percent = 100.0 / diagonal;
  return {{"max", d.max},
          {"mean", d.mean},
          {"rms", d.rms},
          {"max_percent", percent * d.max},
          {"mean_percent", percent * d.mean},
          {"rms_percent", percent * d.rms},
          {"count", d.count}};
}

Json distanceJson(const TwoSidedDistance& distance, double diagonal)
{
  return {{"mesh_to_reference", distanceJson(distance.to_reference, diagonal)},
          {"reference_to_mesh", distanceJson(distance.from_reference, diagonal)},
          {"symmetric", distanceJson(distance.symmetric, diagonal)}};
}

Json normalJson(const NormalDeviation& n)
{
  return {{"mean", n.mean},
          {"median", n.median},
          {"percentile95", n.percentile95},
          {"percent_above_20", 100.0 * n.share_above_20},
          {"count", n.count}};
}

Json meshJson(const std::string& file, const TriangleMesh& mesh, const MeshTopology& t)
{
  return {{"file", file},
          {"vertices", mesh.vertexCount()},
          {"faces", mesh.faceCount()},
          {"referenced_vertices", t.referenced_vertices},
          {"edges", t.edges},
          {"boundary_edges", t.boundary_edges},
          {"nonmanifold_edges", t.nonmanifold_edges},
          {"nonmanifold_vertices", t.nonmanifold_vertices},
          {"inconsistent_edges", t.inconsistent_edges},
          {"components", t.components},
          {"euler", t.euler},
          {"watertight", t.watertight}};
}
/// The table of distances (absolute and in % of the diagonal), normals and topology, for people.
std::string comparisonText(const Comparison& c)
{
  const MeshDistanceResult& r = c.result;
  const double diagonal = r.reference_diagonal;
  std::string text = format("%-20s %35s  %32s\n", "", "absolute distance", "w.r.t. b-box diagonal (%)");
  text += distanceLines(c.options.distance.vertex_to_vertex ? "vertex to vertex" : "vertices", r.vertices, diagonal);
  if (r.surface.symmetric.count > 0)
    text += distanceLines("surface samples", r.surface, diagonal);
  text += format("reference diagonal   %11.6g\n", diagonal);
  if (r.normals_to_reference.count > 0) {
    text += format("\n%-20s %11s %11s %11s  %10s\n", "normals (degrees)", "mean", "median", "95 %", "% above 20");
    text += normalLine("  mesh to reference", r.normals_to_reference);
    text += normalLine("  reference to mesh", r.normals_from_reference);
    if (r.inside_out)
      text += "  the mesh is inside out; the angles are those of the turned mesh\n";
  }
  return text + "\n" + topologyLine("mesh", c.mesh, r.mesh_topology) +
         topologyLine("reference", c.reference, r.reference_topology);
}

/// All numbers; distances in the unit of the meshes, angles in degrees.
Json comparisonJson(const Comparison& c)
{
  const MeshDistanceResult& r = c.result;
  const double diagonal = r.reference_diagonal;
  Json json = {{"mesh", meshJson(c.options.mesh, c.mesh, r.mesh_topology)},
               {"reference", meshJson(c.options.reference, c.reference, r.reference_topology)},
               {"reference_diagonal", diagonal},
               {"vertex_to_vertex", c.options.distance.vertex_to_vertex},
               {"seed", c.options.distance.seed},
               {"vertices", distanceJson(r.vertices, diagonal)}};
  if (r.surface.symmetric.count > 0)
    json["surface"] = distanceJson(r.surface, diagonal);
  if (r.normals_to_reference.count > 0)
    json["normals"] = {{"mesh_to_reference", normalJson(r.normals_to_reference)},
                       {"reference_to_mesh", normalJson(r.normals_from_reference)},
                       {"inside_out", r.inside_out}};
  return json;
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
  const Comparison comparison{options, mesh, reference,
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
