// SPDX-License-Identifier: BSD-3-Clause
#include "support/scan_option.h"
#include "support/tool.h"
#include <algorithm>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/formats.h>
#include <fresco/io/point_files.h>
#include <fresco/io/point_io.h>
#include <fresco/io/pose_file.h>
#include <fresco/io/scan_writer.h>
#include <fresco/registration/core/scan_registration.h>
#include <fstream>
namespace {
using namespace fresco;

struct Request {
  std::vector<fresco::ScanPath> scans;
  std::string folder, start_file, hint_file, e57, to_world;
  bool resume = false;
  ScanRegistrationOptions options;
  CommonOptions common;
};

// What the search and the refinement go by.
void declare(Args& args, ScanRegistrationOptions& options)
{
  args.option("voxel", options.voxel, Range::above(0).zero("from the data"), "finest thinning, unit of the points");
  args.option("max_distance", options.max_distance, Range::above(0).zero("20 voxels"),
              "how far start poses may be off, unit of the points");
  args.option("min_overlap", options.min_overlap, Range::above(0).atMost(1),
              "share of a scan from which a pair of scans is used");
  args.option("max_violation", options.max_violation, Range::within(0, 1),
              "share of a scan in space that the other saw through from which a pair is wrong");
  args.option("confidence", options.confidence, Range::within(0.5, 0.9999).zero("the joins decide"),
              "probability below which scans lose their places and become candidates");
  args.flag("upright", options.upright, "all scanners stood upright to 10 degrees, z upwards");
  args.option("iterations", options.max_iterations, Range::atLeast(1), "of the joint refinement per resolution");
}

Request parse(int argc, char** argv)
{
  Request request;
  Args args(
      "fresco_register SCAN... -o OUT_DIR [-poses START.txt] [options]",
      "Brings scans into one frame.\nSCAN: " + readableExtensions(FileKind::points) +
          ", each in its own frame, or a folder of them.\n"
          "Each scan of a file of several (.e57, .ptx) is one. "
          "Writes poses.txt (world from scan, `none` for a scan without a place), registered.pcd (all placed scans,\n"
          "normals towards each point's own viewpoint), registration.json (overlap graph, residuals, why scans have "
          "no\n"
          "place and where they may be) and registration.html (the same as floor plans).");
  args.option("o", request.folder, "folder of the output, created; required");
  args.option(
      "poses", request.start_file,
      "start poses, one a line as in poses.txt; `none` = unknown; or a file of scans, whose own poses are taken");
  args.flag("fixed", request.options.fixed,
            "scans with a start pose keep it exactly; only those with `none` are placed, against them");
  args.option("hints", request.hint_file,
              "what is known of places, a line each: link A B, relative A B POSE, near A X Y [Z] R, choose A B NUMBER, "
              "apart A B, order; registration.html shows the lines that help");
  args.flag("resume", request.resume, "take what an earlier run into OUT_DIR found of pairs, whatever its hints were");
  args.option("e57", request.e57, "write the placed scans into this file, each with its pose, all fields and pictures");
  args.option("to_world", request.to_world,
              "for -e57: a file of 16 numbers, row by row, from the frame of the result to that of the world");
  declare(args, request.options);
  declareColumns(args);
  request.common.declare(args);
  args.note("example: fresco_register scans/*.pcd -o registered");
  const std::vector<std::string> words = args.parse(argc, argv, 1, 100000);
  if (request.options.fixed && request.start_file.empty())
    throw UsageError("-fixed needs -poses START.txt");
  if (request.folder.empty())
    throw UsageError("-o OUT_DIR is missing");
  if (!request.e57.empty() && extension(request.e57) != ".e57")
    throw UsageError(request.e57 + ": the extension must be .e57");
  if (request.e57.empty() && !request.to_world.empty())
    throw UsageError("-to_world needs -e57 FILE");
  std::vector<std::string> inputs = pointFilesIn(words);
  request.scans = scansOf(inputs, true);
  inputs.insert(inputs.end(), {request.start_file, request.hint_file, request.to_world});
  std::vector<std::string> outputs = {request.e57};
  for (const char* name : {"registered.pcd", "poses.txt", "registration.json", "registration.html", "pairs.bin"})
    outputs.push_back(request.folder + "/" + name);
  requireDistinct(outputs, inputs);
  request.options.threads = request.common.threads;
  for (const fresco::ScanPath& scan : request.scans)
    request.options.names.push_back(scan.name());
  if (!request.hint_file.empty())
    request.options.hints = readHints(request.hint_file, request.options.names);
  return request;
}

std::vector<Pose> startPoses(const Request& request)
{
  if (request.start_file.empty())
    return {};
  std::vector<Pose> poses =
      holdsScans(request.start_file) ? posesOf(scansOf({request.start_file})) : readPoses(request.start_file);
  if (poses.size() != request.scans.size())
    throw std::runtime_error(
        concat(request.start_file, ": ", poses.size(), " poses for ", request.scans.size(), " scans"));
  return poses;
}

// Normals point to viewpoints: also to those that were found.
PointSet withViewpoint(PointSet scan, const ScanResult& result)
{
  if (result.found_viewpoint)
    scan.viewpoints = (*result.found_viewpoint - scan.origin).cast<float>();
  return scan;
}

void writeE57(const Request& request, const Pose& T_world_result, std::vector<Pose> poses)
{
  for (Pose& pose : poses)
    if (pose && T_world_result)
      pose = *T_world_result * *pose;
  writeScansAt(request.e57, request.scans, poses);
}

void write(const Request& request, const ScanSource& files, const ScanRegistrationResult& result,
           const Pose& T_world_result)
{
  const ScanSource scans(files.count, [&](Index i) { return withViewpoint(files.read(i), result.scans[i]); });
  writePoints(request.folder + "/registered.pcd", mergeScans(scans, result.poses, request.common.threads));
  writePoses(request.folder + "/poses.txt", result.poses);
  writeFile(request.folder + "/registration.json", registrationJson(result, request.options));
  writeFile(request.folder + "/registration.html", registrationPage(result, request.options));
  if (files.memory != nullptr && !files.memory->used)
    writeFile(request.folder + "/pairs.bin", files.memory->bytes);
  if (!request.e57.empty())
    writeE57(request, T_world_result, result.poses);
}

// Not among the inputs of this run, which replaces it where it does not fit.
std::string earlierBytes(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void run(int argc, char** argv)
{
  const Request request = parse(argc, argv);
  const std::vector<Pose> start = startPoses(request);
  const Pose T_world_result = request.to_world.empty() ? Pose() : readTransform(request.to_world);
  makeFolder(request.folder);
  const FolderLock lock(request.folder, "fresco_register");
  const Progress progress = printProgress(request.common.quiet);
  PairMemory memory;
  if (request.resume)
    memory.bytes = earlierBytes(request.folder + "/pairs.bin");
  ScanSource scans(request.scans.size(), [&](Index i) { return readPoints(request.scans[i]); });
  scans.memory = &memory;
  report(progress, "read", 0.0);
  const auto result = registerScans(scans, start, request.options, subProgress(progress, 0.0, 0.9));
  if (request.resume && !memory.used)
    inform(request.common.quiet,
           "warning: no earlier run with these scans and options in " + request.folder + ": all pairs were searched");
  const auto placed = std::count_if(result.scans.begin(), result.scans.end(), [](const auto& s) { return s.placed; });
  if (placed == 0)
    throw std::runtime_error(request.options.names[0] + ": " + result.scans[0].problem + "; no scan could be placed");
  report(progress, "write", 0.9);
  writeOutputs([&] { write(request, scans, result, T_world_result); });
  report(progress, "done", 1.0);
  for (const std::string& warning : registrationWarnings(result, request.options))
    inform(request.common.quiet, "warning: " + warning);
  inform(request.common.quiet, concat(placed, " of ", scans.count, " scans placed, rms ", result.rms));
}
} // namespace

int main(int argc, char** argv)
{
  return runTool("fresco_register", [&] { run(argc, argv); });
}
