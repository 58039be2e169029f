// SPDX-License-Identifier: BSD-3-Clause
#include "support/tool.h"
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <fresco/surface/core/surface_optimization.h>
#include <limits>
#include <malloc.h>
namespace {
struct Request {
  std::string mesh, cloud, output, mode = "best", report;
  fresco::SurfaceOptimizationOptions options;
  fresco::CommonOptions common;
};

Request parse(int argc, char** argv)
{
  Request request;
  fresco::SurfaceOptimizationOptions& o = request.options;
  fresco::Args args(
      "fresco_optimize MESH CLOUD OUT [options]",
      "Moves the vertices of MESH so that it fits the points of CLOUD that it was made of and gets its sharp\n"
      "edges back. MESH, OUT: PLY, OBJ or VTK; CLOUD: PCD, PLY, VTK, OBJ or XYZ, with or without normals.\n"
      "OUT has the faces, colours and other attributes of MESH. Vertices without data stay where they were.");
  args.option("iterations", o.iterations, "at most, 1..10000; 0 = 15, in faithful mode 200");
  args.option("kappa1", o.kappa1, "weight of smoothness, >= 0; negative = 1, in faithful mode 0.1");
  args.option("kappa2", o.kappa2,
              "weight of well-shaped triangles, at the start in faithful mode, >= 0; negative = 0.1");
  args.flag("flip", o.flip, "flip edges so that they follow the creases");
  args.option("mode", request.mode,
              "best or faithful (conjugate gradients on E_fit + kappa1 E_smooth + kappa2 E_topology)");
  args.option("tolerance", o.tolerance, "ends when a step moves the vertices by less, RMS in mean edge lengths, >= 0");
  args.option("report", request.report, "file for the terms of each iteration and a summary, JSON");
  args.note("fresco_reconstruct scan.ply mesh.ply -depth 8\nfresco_optimize mesh.ply scan.ply sharp.ply");
  request.common.declare(args);
  const std::vector<std::string> files = args.parse(argc, argv, 3);
  request.mesh = files[0];
  request.cloud = files[1];
  request.output = files[2];
  if (request.mode != "best" && request.mode != "faithful")
    throw fresco::UsageError("-mode is best or faithful, not '" + request.mode + "'");
  o.mode = request.mode == "best" ? fresco::OptimizationMode::best : fresco::OptimizationMode::faithful;
  if (o.iterations < 0 || o.iterations > 10000)
    throw fresco::UsageError(fresco::concat("option -iterations: ", o.iterations, " is not within 0 and 10000"));
  if (o.tolerance < 0)
    throw fresco::UsageError(fresco::concat("option -tolerance: ", o.tolerance, " is negative"));
  o.threads = request.common.threads;
  return request;
}

std::string toJson(const fresco::SurfaceOptimizationResult& r)
{
  std::string text = fresco::concat(
      "{\n \"converged\": ", r.converged ? "true" : "false", ",\n \"mean_edge_length\": ", r.edge_length,
      ",\n \"noise\": ", r.noise, ",\n \"point_spacing\": ", r.spacing, ",\n \"used_points\": ", r.used_points,
      ",\n \"left_out_points\": ", r.left_out_points, ",\n \"vertices\": ", r.mesh.vertexCount(),
      ",\n \"supported_vertices\": ", r.supported_vertices, ",\n \"restored_vertices\": ", r.restored_vertices,
      ",\n \"flipped_edges\": ", r.flipped_edges, ",\n \"steps\": [");
  const char* separator = "\n";
  for (const fresco::OptimizationStep& s : r.steps) {
    text += fresco::concat(separator, "  {\"fit\": ", s.fit, ", \"smooth\": ", s.smooth, ", \"topology\": ", s.topology,
                           ", \"kappa2\": ", s.kappa2, ", \"before\": ", s.before, ", \"after\": ", s.after,
                           ", \"move\": ", s.move, "}");
    separator = ",\n";
  }
  return text + "\n ]\n}\n";
}

/// Arrays of each iteration use the pages of the last one's: fresh pages from the kernel cost 7 % of the time.
void keepFreedMemory()
{
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
}

void run(const Request& request)
{
  keepFreedMemory();
  const fresco::TriangleMesh mesh = fresco::readMesh(request.mesh);
  if (mesh.faceCount() == 0)
    throw std::runtime_error(request.mesh + ": no faces");
  const fresco::SurfaceOptimizationResult result = fresco::optimizeSurface(
      mesh, fresco::readPoints(request.cloud), request.options, fresco::printProgress(request.common.quiet));
  fresco::writeOutputs([&] {
    fresco::writeMesh(request.output, result.mesh);
    if (!request.report.empty())
      fresco::writeFile(request.report, toJson(result));
  });
  fresco::inform(request.common.quiet,
                 fresco::concat(result.steps.size(), " iterations", result.converged ? ", converged" : "", "; noise ",
                                result.noise, ", mean edge ", result.edge_length, "; ", result.supported_vertices,
                                " of ", mesh.vertexCount(), " vertices have data, ", result.restored_vertices,
                                " put back; ", result.flipped_edges, " edges flipped; ", result.left_out_points,
                                " points left out"));
}
} // namespace

int main(int argc, char** argv)
{
  return fresco::runTool("fresco_optimize", [&] {
    const Request request = parse(argc, argv);
    try {
      run(request);
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(request.mesh + ": " + error.what());
    }
  });
}
