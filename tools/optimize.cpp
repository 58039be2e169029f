// SPDX-License-Identifier: BSD-3-Clause
#include "support/scan_option.h"
#include "support/tool.h"
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/formats.h>
#include <fresco/io/json_text.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <fresco/surface/core/normal_filtering.h>
#include <limits>
#include <malloc.h>
#include <nlohmann/json.hpp>
namespace {
using namespace fresco;
using Json = nlohmann::ordered_json;

struct Request {
  std::string mesh, cloud, output, report;
  NormalFilteringOptions options;
  CommonOptions common;
  ScanOption scan;
};

void declare(Args& args, Request& request)
{
  NormalFilteringOptions& options = request.options;
  args.option("iterations", options.iterations, Range::within(1, 8), "most iterations");
  args.option("kappa1", options.smoothness_weight, Range::atLeast(0), "weight of smoothness");
  args.option("kappa2", options.tangential_weight, Range::atLeast(0), "weight of well-shaped triangles");
  args.option("tolerance", options.tolerance, Range::atLeast(0),
              "ends when a step moves the vertices by less, RMS in mean edge lengths");
  args.flag("flip", options.flip, "flip edges so that they follow the creases");
  args.option("report", request.report, "file for the terms of each iteration and a summary, JSON");
  args.note("fresco_reconstruct scan.ply mesh.ply -depth 8\nfresco_optimize mesh.ply scan.ply sharp.ply");
  request.scan.declare(args);
  request.common.declare(args);
}

Request parse(int argc, char** argv)
{
  Request request;
  Args args("fresco_optimize MESH CLOUD OUT [options]",
            "Moves the vertices of MESH so that it fits the points of CLOUD that it was made of and gets its sharp\n"
            "edges back.\nMESH: " +
                readableExtensions(FileKind::mesh) + "; OUT: " + writableExtensions(FileKind::mesh) +
                ";\nCLOUD: " + readableExtensions(FileKind::points) +
                ", with or without normals.\n"
                "OUT has the faces, colours and other attributes of MESH. Vertices without data stay where they were;\n"
                "those whose data would be farther off than before go back.");
  declare(args, request);
  const std::vector<std::string> files = args.parse(argc, argv, 3);
  request.mesh = files[0];
  request.cloud = files[1];
  request.output = files[2];
  requireDistinct({request.output, request.report}, {request.mesh, request.cloud});
  request.options.threads = request.common.threads;
  return request;
}

Json toJson(const NormalFilteringStep& s)
{
  return {{"fit", s.fit},       {"smoothness", s.smoothness}, {"tangential", s.tangential},
          {"before", s.before}, {"after", s.after},           {"move", s.move}};
}

Json toJson(const NormalFilteringResult& r)
{
  Json json = {{"converged", r.converged},
               {"mean_edge_length", r.edge_length},
               {"point_spacing", r.spacing},
               {"used_points", r.used_points},
               {"left_out_points", r.left_out_points},
               {"turned_faces", r.turned_faces},
               {"vertices", r.mesh.vertexCount()},
               {"covered_vertices", r.covered_vertices},
               {"restored_vertices", r.restored_vertices},
               {"noise", r.noise},
               {"flipped_edges", r.flipped_edges},
               {"steps", Json::array()}};
  for (const NormalFilteringStep& step : r.steps)
    json["steps"].push_back(toJson(step));
  return json;
}

void write(const Request& request, const NormalFilteringResult& r)
{
  writeOutputs([&] {
    writeMesh(request.output, r.mesh);
    if (!request.report.empty())
      writeFile(request.report, jsonText(toJson(r), 1));
  });
  inform(request.common.quiet, concat(r.iterations, " iterations", r.converged ? ", converged" : "", "; mean edge ",
                                      r.edge_length, "; ", r.covered_vertices, " of ", r.mesh.vertexCount(),
                                      " vertices have data, ", r.restored_vertices, " put back; ", r.left_out_points,
                                      " points left out; noise ", r.noise, "; ", r.flipped_edges, " edges flipped"));
  if (r.turned_faces > 0)
    inform(request.common.quiet, concat(r.turned_faces, " of ", r.mesh.faceCount(),
                                        " faces were inside out, against the normals of the points, and are turned"));
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
  const TriangleMesh mesh = readMesh(request.mesh);
  if (mesh.faceCount() == 0)
    throw std::runtime_error(request.mesh + ": no faces");
  const PointSet points = readPoints(request.scan.of(request.cloud));
  write(request, filterSurface(mesh, points, request.options, printProgress(request.common.quiet)));
}
} // namespace

int main(int argc, char** argv)
{
  return runTool("fresco_optimize", [&] {
    const Request request = parse(argc, argv);
    try {
      run(request);
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(request.mesh + ": " + error.what());
    }
  });
}
