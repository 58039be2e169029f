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
#include <fresco/surface/core/surface_energy.h>
#include <limits>
#include <malloc.h>
#include <nlohmann/json.hpp>
#include <type_traits>
namespace {
using namespace fresco;
using Json = nlohmann::ordered_json;

struct Request {
  std::string mesh, cloud, output, mode = "normal_filtering", report;
  NormalFilteringOptions filtering;
  EnergyOptions energy;
  CommonOptions common;
  ScanOption scan;
};

// An option of both modes, >= 0; the help shows the default of each.
void optionOfBoth(Args& args, const std::string& name, double& filtering, double& energy, const std::string& help)
{
  args.values(name, "X", concat(help, " (default ", filtering, "; with -mode energy ", energy, ")"),
              [&, name](const auto& words) {
                filtering = energy = Args::number(name, words[0]);
                if (energy < 0)
                  throw UsageError(concat("option -", name, ": ", energy, " is negative"));
              });
}

void iterationsOfBoth(Args& args, int& filtering, int& energy)
{
  const std::string help = concat("at most, 1..10000 (default ", filtering, "; with -mode energy ", energy, ")");
  args.values("iterations", "N", help, [&](const auto& words) {
    const long long number = Args::integer("iterations", words[0]);
    if (number < 1 || number > 10000)
      throw UsageError(concat("option -iterations: ", number, " is not within 1 and 10000"));
    filtering = energy = number;
  });
}

void declare(Args& args, Request& request)
{
  NormalFilteringOptions& f = request.filtering;
  EnergyOptions& e = request.energy;
  args.option("mode", request.mode,
              "normal_filtering, or energy (conjugate gradients on E_fit + kappa1 E_smooth + kappa2 E_topology); "
              "the old names best and faithful are accepted in this version");
  iterationsOfBoth(args, f.iterations, e.iterations);
  optionOfBoth(args, "kappa1", f.smoothness_weight, e.kappa1, "weight of smoothness, >= 0");
  optionOfBoth(args, "kappa2", f.tangential_weight, e.kappa2,
               "weight of well-shaped triangles, in mode energy at the start, >= 0");
  optionOfBoth(args, "tolerance", f.tolerance, e.tolerance,
               "ends when a step moves the vertices by less, RMS in mean edge lengths, >= 0");
  args.flag("flip", f.flip, "flip edges so that they follow the creases (mode normal_filtering)");
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
  if (request.mode == "best")
    request.mode = "normal_filtering";
  if (request.mode == "faithful")
    request.mode = "energy";
  if (request.mode != "normal_filtering" && request.mode != "energy")
    throw UsageError("-mode is normal_filtering or energy, not '" + request.mode + "'");
  if (request.mode == "energy" && request.filtering.flip)
    throw UsageError("-flip is an option of -mode normal_filtering");
  request.filtering.threads = request.energy.threads = request.common.threads;
  return request;
}

Json toJson(const NormalFilteringStep& s)
{
  return {{"fit", s.fit},       {"smoothness", s.smoothness}, {"tangential", s.tangential},
          {"before", s.before}, {"after", s.after},           {"move", s.move}};
}

Json toJson(const EnergyStep& s)
{
  return {{"fit", s.fit},       {"smooth", s.smooth}, {"topology", s.topology}, {"kappa2", s.kappa2},
          {"before", s.before}, {"after", s.after},   {"move", s.move}};
}

template <typename Result>
constexpr bool is_filtering = std::is_same_v<Result, NormalFilteringResult>;

template <typename Result>
Json toJson(const Result& r)
{
  Json json = {{"converged", r.converged},
               {"mean_edge_length", r.edge_length},
               {"point_spacing", r.spacing},
               {"used_points", r.used_points},
               {"left_out_points", r.left_out_points},
               {"vertices", r.mesh.vertexCount()},
               {"covered_vertices", r.covered_vertices},
               {"restored_vertices", r.restored_vertices}};
  if constexpr (is_filtering<Result>) {
    json["noise"] = r.noise;
    json["flipped_edges"] = r.flipped_edges;
  }
  json["steps"] = Json::array();
  for (const auto& step : r.steps)
    json["steps"].push_back(toJson(step));
  return json;
}

template <typename Result>
void write(const Request& request, const Result& r)
{
  writeOutputs([&] {
    writeMesh(request.output, r.mesh);
    if (!request.report.empty())
      writeFile(request.report, jsonText(toJson(r), 1));
  });
  std::string line =
      concat(r.iterations, " iterations", r.converged ? ", converged" : "", "; mean edge ", r.edge_length, "; ",
             r.covered_vertices, " of ", r.mesh.vertexCount(), " vertices have data, ", r.restored_vertices,
             " put back; ", r.left_out_points, " points left out");
  if constexpr (is_filtering<Result>)
    line += concat("; noise ", r.noise, "; ", r.flipped_edges, " edges flipped");
  inform(request.common.quiet, line);
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
  const Progress progress = printProgress(request.common.quiet);
  if (request.mode == "energy")
    write(request, minimizeSurfaceEnergy(mesh, points, request.energy, progress));
  else
    write(request, filterSurface(mesh, points, request.filtering, progress));
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
