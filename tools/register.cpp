// SPDX-License-Identifier: BSD-3-Clause
#include "support/scan_option.h"
#include "support/tool.h"
#include <algorithm>
#include <fresco/core/constants.h>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/formats.h>
#include <fresco/io/json_text.h>
#include <fresco/io/point_files.h>
#include <fresco/io/point_io.h>
#include <fresco/io/pose_file.h>
#include <fresco/io/scan_file.h>
#include <fresco/registration/core/scan_registration.h>
#include <nlohmann/json.hpp>
namespace {
using namespace fresco;

using Json = nlohmann::ordered_json;

struct Request {
  std::vector<fresco::ScanPath> scans;
  std::string folder, start_file;
  ScanRegistrationOptions options;
  CommonOptions common;
};

Request parse(int argc, char** argv)
{
  Request request;
  Args args(
      "fresco_register SCAN... -o OUT_DIR [-poses START.txt] [options]",
      "Brings scans into one frame.\nSCAN: " + readableExtensions(FileKind::points) +
          ", each in its own frame, or a folder of them.\n"
          "Each scan of a file of several (.e57, .ptx) is one. "
          "Writes poses.txt (world from scan, `none` for a scan without a place), registered.pcd (all placed scans,\n"
          "normals towards each point's own viewpoint) and registration.json (overlap graph, residuals, unplaced "
          "scans).");
  args.option("o", request.folder, "folder of the output, created; required");
  args.option(
      "poses", request.start_file,
      "start poses, one a line as in poses.txt; `none` = unknown; or a file of scans, whose own poses are taken");
  args.flag("fixed", request.options.fixed,
            "scans with a start pose keep it exactly; only those with `none` are placed, against them");
  args.option("voxel", request.options.voxel, "finest thinning, unit of the points; 0 = from the data");
  args.option("max_distance", request.options.max_distance,
              "how far start poses may be off, unit of the points; 0 = 20 voxels");
  args.option("min_overlap", request.options.min_overlap,
              "share of a scan from which a pair of scans is used, above 0 and at most 1");
  args.option("max_violation", request.options.max_violation,
              "share of a scan in space that the other saw through from which a pair is wrong, 0..1");
  args.flag("upright", request.options.upright, "all scanners stood upright to 10 degrees, z upwards");
  args.option("iterations", request.options.max_iterations, "of the joint refinement per resolution, at least 1");
  declareColumns(args);
  request.common.declare(args);
  args.note("example: fresco_register scans/*.pcd -o registered");
  const std::vector<std::string> words = args.parse(argc, argv, 1, 100000);
  if (request.options.fixed && request.start_file.empty())
    throw UsageError("-fixed needs -poses START.txt");
  if (request.folder.empty())
    throw UsageError("-o OUT_DIR is missing");
  std::vector<std::string> inputs = pointFilesIn(words);
  request.scans = scansOf(inputs, true);
  inputs.push_back(request.start_file);
  requireDistinct(
      {request.folder + "/registered.pcd", request.folder + "/poses.txt", request.folder + "/registration.json"},
      inputs);
  request.options.threads = request.common.threads;
  for (const fresco::ScanPath& scan : request.scans)
    request.options.names.push_back(scan.name());
  return request;
}

Json toJson(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

// By rows.
Json rowsJson(const Eigen::MatrixXd& matrix)
{
  Json rows = Json::array();
  for (Index r = 0; r < matrix.rows(); ++r) {
    Json& row = rows.emplace_back(Json::array());
    for (Index c = 0; c < matrix.cols(); ++c)
      row.push_back(matrix(r, c));
  }
  return rows;
}

Json pairJson(const PairResult& pair)
{
  Json json = {{"a", pair.a},
               {"b", pair.b},
               {"overlap", pair.overlap},
               {"violation", pair.violation},
               {"rms", pair.rms},
               {"matches", pair.matches},
               {"accepted", pair.accepted},
               {"pose", rowsJson(pair.T_a_b)},
               {"information", pair.information.isZero() ? Json() : rowsJson(pair.information)},
               {"information_point", toJson(pair.information_point)}};
  json["alternatives"] = Json::array();
  for (const AlternativePose& pose : pair.alternatives)
    json["alternatives"].push_back(
        {{"pose", rowsJson(pose.T_a_b)}, {"overlap", pose.overlap}, {"violation", pose.violation}});
  return json;
}

Json scanJson(const std::string& file, const ScanResult& scan, const Pose& pose)
{
  Json json = {{"file", file}, {"placed", scan.placed}, {"group", scan.group}};
  json["pose"] = pose ? rowsJson(*pose) : Json();
  json["pose_in_group"] = scan.group >= 0 ? rowsJson(scan.T_group_scan) : Json();
  json["problem"] = scan.problem;
  json["duplicate_of"] = scan.duplicate_of;
  json["viewpoint_problem"] = scan.viewpoint_problem;
  if (scan.found_viewpoint)
    json["found_viewpoint"] = toJson(*scan.found_viewpoint);
  json["rms"] = scan.rms;
  json["translation_deviation"] = scan.translation_deviation;
  json["rotation_deviation_deg"] = scan.rotation_deviation * 180.0 / pi;
  if (scan.free_motion)
    json["free_motion"] = {{"translation", toJson(scan.free_motion->translation)},
                           {"rotation", toJson(scan.free_motion->rotation)}};
  return json;
}

std::string reportText(const Request& request, const ScanRegistrationResult& result)
{
  Json json;
  json["scans"] = Json::array();
  json["unplaced"] = Json::array();
  const std::vector<std::string>& names = request.options.names;
  for (std::size_t i = 0; i < names.size(); ++i) {
    json["scans"].push_back(scanJson(names[i], result.scans[i], result.poses[i]));
    if (!result.scans[i].placed)
      json["unplaced"].push_back(names[i]);
  }
  json["pairs"] = Json::array();
  for (const PairResult& pair : result.pairs)
    json["pairs"].push_back(pairJson(pair));
  json["warnings"] = registrationWarnings(result, request.options);
  json["groups"] = result.groups;
  json["rms"] = result.rms;
  json["voxel"] = result.voxel;
  json["iterations"] = result.iterations;
  json["converged"] = result.converged;
  return fresco::jsonText(json, 1);
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

void write(const Request& request, const ScanSource& files, const ScanRegistrationResult& result)
{
  const ScanSource scans(files.count, [&](Index i) { return withViewpoint(files.read(i), result.scans[i]); });
  writePoints(request.folder + "/registered.pcd", mergeScans(scans, result.poses, request.common.threads));
  writePoses(request.folder + "/poses.txt", result.poses);
  writeFile(request.folder + "/registration.json", reportText(request, result));
}

void run(int argc, char** argv)
{
  const Request request = parse(argc, argv);
  const std::vector<Pose> start = startPoses(request);
  makeFolder(request.folder);
  const FolderLock lock(request.folder, "fresco_register");
  const Progress progress = printProgress(request.common.quiet);
  const ScanSource scans(request.scans.size(), [&](Index i) { return readPoints(request.scans[i]); });
  report(progress, "read", 0.0);
  const auto result = registerScans(scans, start, request.options, subProgress(progress, 0.0, 0.9));
  const auto placed = std::count_if(result.scans.begin(), result.scans.end(), [](const auto& s) { return s.placed; });
  if (placed == 0)
    throw std::runtime_error(request.options.names[0] + ": " + result.scans[0].problem + "; no scan could be placed");
  report(progress, "write", 0.9);
  writeOutputs([&] { write(request, scans, result); });
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
