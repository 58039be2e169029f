// SPDX-License-Identifier: BSD-3-Clause
#include "support/ranks.h"
#include "support/scan_option.h"
#include "support/tool.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/core/scratch_space.h>
#include <fresco/distributed/mesh_part.h>
#include <fresco/io/file.h>
#include <fresco/io/formats.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_files.h>
#include <fresco/io/shared_files.h>
#include <fresco/surface/core/volumetric_reconstruction.h>
#include <iostream>
#include <limits>
#include <optional>
namespace {
using namespace fresco;

struct Request {
  std::vector<ScanPath> inputs;
  std::string output;
  VolumetricOptions options;
  CommonOptions common;
  bool estimate = false;
  bool free_space = false; ///< no surface where beams passed
  bool parts = false;      ///< each rank writes a file
  int memory = 0;          ///< MB, 0 = no limit
  std::string scratch;     ///< folder
};

std::size_t bytes(int megabytes) { return std::max(0, megabytes) * std::size_t{1000000}; }

void declareOptions(Args& args, Request& request)
{
  VolumetricOptions& o = request.options;
  args.option("depth", o.depth, Range::within(2, 16), "octree depth; finest cell = cube side / 2^depth");
  args.option("cell", o.cell_size, Range::above(0).zero("from -depth"),
              "side of the finest cell, unit of the points, which sets the depth");
  args.option("point_weight", o.point_weight, Range::above(0).zero("unscreened"),
              "weight of passing through the points");
  args.option("samples_per_node", o.samples_per_node, Range::above(0),
              "points that a cell needs to sustain its depth; more = smoother");
  args.option("trim", o.trim, Range::above(0).zero("keep it closed"),
              "an octree depth: cut the surface away where the data sustain less than it");
  args.option("trim_levels", o.trim_levels, Range::above(0).zero("keep it closed"),
              "octree levels: the same, but so many levels below the depth that the best-sampled quarter of the "
              "surface reaches");
  args.flag("confidence", o.confidence,
            "weight the points by their field `confidence`, else by the length of their normals");
  args.flag("free_space", request.free_space,
            "no surface where beams passed: IN has viewpoints, of up to 1000 stations; it is read once more");
  args.option("scale", o.scale, Range::within(1, 100), "cube side / longest side of the points' bounding box");
  args.option("min_depth", o.min_depth, Range::within(2, 8), "the octree is complete down to this depth");
  args.option("iterations", o.iterations, Range::within(1, 1000), "solver sweeps per octree depth");
  args.flag("estimate", request.estimate,
            "print three numbers on stdout and stop, without writing OUT: MB of memory, MB of scratch files with this "
            "-memory, seconds to about a factor of two");
  args.flag(
      "parts", request.parts,
      "of fresco_reconstruct_mpi: each rank writes its part as a mesh by itself, OUT_0000.ply ..., and the first an "
      "index of them, OUT.json");
  args.option("memory", request.memory, Range::atLeast(ScratchSpace::least_memory / 1e6).zero("all in memory"),
              "MB to stay below: arrays that do not fit go to files in -scratch; the same bytes come out");
  args.option("scratch", request.scratch, "folder for such files, on a fast disk; default: the folder of OUT");
}

Request parse(int argc, char** argv, const std::string& program)
{
  Request request;
  VolumetricOptions& o = request.options;
  Args args(
      program + " IN... OUT [options]",
      "Volumetric surface reconstruction (screened Poisson over an octree) of points with normals.\n"
      "IN: " +
          readableExtensions(FileKind::points) +
          ", with normals that point to the free side; a folder stands for the files of\npoints in it. "
          "Several are taken as one cloud. Binary .ply and .pcd are read in windows, several times, and may be larger\n"
          "than memory. Other files are read whole: a single one once, several one after the other, several "
          "times.\nOUT: " +
          writableExtensions(FileKind::mesh) +
          ", a mesh, closed\n"
          "and manifold unless trimmed, with colours and intensity where IN has them and the field `support`: the\n"
          "octree depth that the data sustain at the vertex.");
  declareOptions(args, request);
  args.note("fresco_reconstruct scan.ply mesh.ply -depth 9\n"
            "fresco_reconstruct room.pcd room.ply -cell 0.02 -trim_levels 2   (an open room: cells of 2 cm, no "
            "invented surface)");
  args.note(
      "fresco_reconstruct_mpi: several ranks share octrees of depth 10 and more. To trim, they send the mesh to the "
      "first rank,\nwhich then needs some 100 bytes per vertex of the untrimmed mesh.");
  fresco::ScanOption scan;
  scan.declare(args);
  request.common.declare(args);
  std::vector<std::string> files = args.parse(argc, argv, 2, std::numeric_limits<std::size_t>::max());
  o.threads = request.common.threads;
  try {
    validateVolumetricOptions(o);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  if (request.parts && program == "fresco_reconstruct")
    throw UsageError("-parts goes with fresco_reconstruct_mpi");
  if (!request.scratch.empty() && request.memory == 0)
    throw UsageError("-scratch goes with -memory");
  request.output = files.back();
  files.pop_back();
  files = pointFilesIn(files);
  if (scan.number > 0 && files.size() > 1)
    throw UsageError("-scan chooses a scan of one file");
  for (const std::string& file : files)
    request.inputs.push_back(scan.of(file));
  requireDistinct({request.output}, files);
  return request;
}

/// What errors that concern all points name.
std::string nameOf(const std::vector<ScanPath>& inputs)
{
  return inputs.size() == 1 ? inputs[0].file : concat(inputs[0].file, " and ", inputs.size() - 1, " more");
}

std::string scratchFolder(const Request& request)
{
  if (!request.scratch.empty())
    return request.scratch;
  const std::string folder = std::filesystem::path(request.output).parent_path().string();
  return folder.empty() ? "." : folder;
}

std::string percent(Index part, Index whole) { return concat(std::round(1000.0 * part / whole) / 10, " %"); }

/// The points with their viewpoints, a file at a time.
class Beams : public PointStream {
public:
  explicit Beams(const std::vector<ScanPath>& files) : files_(files) {}
  void read(const std::function<void(const PointSet&)>& receive) const override
  {
    for (const ScanPath& file : files_)
      receive(readPoints(file));
  }

private:
  const std::vector<ScanPath>& files_;
};

/// The mesh of all points, by this process.
VolumetricResult makeAlone(const Request& request)
{
  VolumetricOptions options = request.options;
  if (request.free_space)
    options.free_space = std::make_shared<FreeSpaceMap>(Beams(request.inputs));
  VolumetricResult result =
      reconstructVolumetric(openPointFiles(request.inputs), options, printProgress(request.common.quiet));
  {
    const FileBacking vertices(result.mesh.vertices), faces(result.mesh.faces);
    writeOutputs([&] { writeMesh(request.output, result.mesh); });
  }
  return result;
}

/// The same, by several ranks.
VolumetricPart makeTogether(const Request& request, Exchange& ranks)
{
  if (extension(request.output) != ".ply")
    throw UsageError("OUT: several ranks write .ply");
  std::unique_ptr<PointStream> points = openPointFiles(request.inputs, points_per_window, {ranks.rank(), ranks.size()});
  VolumetricPart part =
      reconstructVolumetricPart(std::move(points), request.options, printProgress(request.common.quiet), ranks);
  const auto runs = [](const std::vector<VolumetricPart::Run>& own) {
    std::vector<MeshPart::Run> all;
    for (const VolumetricPart::Run& run : own)
      all.push_back({run.first, run.count});
    return all;
  };
  const MeshPart own{part.result.mesh, runs(part.vertices), runs(part.faces), part.vertex_count, part.face_count};
  if (request.parts)
    writeMeshParts(request.output, own, ranks);
  else
    writeMeshPart(request.output, own, ranks);
  return part;
}

/// Counts of the whole mesh, whoever made it.
void tellCounts(const Request& request, const VolumetricResult& result, Index vertices, Index faces)
{
  inform(request.common.quiet,
         concat(vertices, " vertices, ", faces, " faces; depth ", result.depth, ", cell ", result.cell_size, "; ",
                result.used_points, " points used, ", result.left_out_points, " left out (",
                percent(result.left_out_points, result.used_points + result.left_out_points), ")"));
}

void printEstimate(const Request& request)
{
  constexpr std::size_t program = 40'000'000; // libraries, threads
  VolumetricEstimate estimate = estimateVolumetric(*openPointFiles(request.inputs), request.options);
  estimate.memory += program;
  const std::size_t kept = request.memory == 0 ? estimate.memory : ScratchSpace::keptInMemory(bytes(request.memory));
  std::cout << std::ceil(estimate.memory / 1e6) << ' '
            << std::ceil((estimate.memory - std::min(kept, estimate.memory)) / 1e6) << ' '
            << std::ceil(estimate.seconds) << '\n';
}

void run(const Request& request, Exchange& ranks)
{
  std::vector<std::string> files;
  for (const ScanPath& input : request.inputs)
    files.push_back(input.file);
  requireSameFiles(files, nameOf(request.inputs), ranks);
  if (request.estimate)
    return ranks.rank() == 0 ? printEstimate(request) : void();
  std::optional<ScratchSpace> scratch;
  if (request.memory > 0)
    scratch.emplace(bytes(request.memory), scratchFolder(request));
  if (request.free_space && (ranks.size() > 1 || request.parts))
    throw UsageError("-free_space goes with one process, without -parts");
  if (request.parts)
    requireDistinct(meshPartFiles(request.output, ranks.size()), files);
  if (ranks.size() == 1 && !request.parts) {
    const VolumetricResult result = makeAlone(request);
    return tellCounts(request, result, result.mesh.vertexCount(), result.mesh.faceCount());
  }
  const VolumetricPart part = makeTogether(request, ranks);
  tellCounts(request, part.result, part.vertex_count, part.face_count);
}
} // namespace

int main(int argc, char** argv)
{
  return runRanks("fresco_reconstruct", argc, argv, [&](const std::string& program, Exchange& ranks) {
    Request request = parse(argc, argv, program);
    request.common.quiet |= ranks.rank() > 0;
    try {
      run(request, ranks);
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(nameOf(request.inputs) + ": " + error.what());
    }
  });
}
