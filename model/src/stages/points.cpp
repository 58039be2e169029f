// SPDX-License-Identifier: BSD-3-Clause
#include "stages/placed_points.h"
#include "stages/stages.h"
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fresco/core/constants.h>
#include <fresco/core/require.h>
#include <fresco/filters/core/bilateral_normals.h>
#include <fresco/filters/core/mixed_pixels.h>
#include <fresco/filters/core/oriented_normals.h>
#include <fresco/filters/core/outliers.h>
#include <fresco/io/file.h>
#include <fresco/io/packing.h>
#include <fresco/io/point_io.h>
#include <fresco/io/pose_file.h>
#include <fresco/registration/core/scan_registration.h>
#include <fstream>
#include <utility>
namespace fresco::model {
namespace fs = std::filesystem;
/// `set` without points that are not finite or have no normal; normals smoothed.
PointSet smoothed(const PointSet& set, const Job& job, const Progress& progress)
{
  BilateralOptions smoothing = job.stages.smoothing;
  smoothing.rounds = job.options.bilateral;
  PointSet result = set;
  result.normals = smoothNormals(set, set.normals, smoothing, progress).normals;
  std::vector<Index> kept;
  for (Index i = 0; i < result.size(); ++i)
    if (result.points.col(i).allFinite() && result.normals.col(i).allFinite())
      kept.push_back(i);
  return selectPoints(result, kept);
}

namespace {
/// Beams of a sparser scan stand too far apart to tell a mixed pixel from an edge: see docs/mixed_pixels.md.
constexpr Index least_points_for_mixed_pixels = 100000;

/// Without mixed pixels at depth jumps and isolated points.
PointSet cleaned(const PointSet& scan, const StageOptions& options)
{
  const PointSet solid =
      scan.size() < least_points_for_mixed_pixels
          ? scan
          : selectPoints(scan, withoutMixedPixels(scan.points, scan.viewpoints, options.mixed_pixels));
  return selectPoints(solid, withoutOutliers(solid.points, options.outliers));
}

/// A scan in its own frame, cleaned, with normals that point to the scanner.
PointSet preparedScan(PointSet read, const Job& job, const Progress& progress)
{
  if (read.viewpoints.cols() == 0)
    read.viewpoints = (-read.origin).cast<float>(); // the scanner stands at the origin of its scan's frame
  PointSet scan = cleaned(read, job.stages);
  const NormalField field = estimateNormals(scan, job.stages.normals, subProgress(progress, 0.3, 0.6));
  scan.normals = field.normals;
  scan.confidences = field.confidences;
  return smoothed(scan, job, subProgress(progress, 0.6, 1.0));
}

/// Whether some scans have a pose and others do not.
bool isPartial(const std::vector<Pose>& poses)
{
  const auto known = std::count_if(poses.begin(), poses.end(), [](const Pose& pose) { return pose.has_value(); });
  return known > 0 && known < Index(poses.size());
}

/// As an earlier run left it, on all ranks the same. It is no input: this run may replace it.
PairMemory pairMemory(const Job& job)
{
  std::ifstream file(job.options.resume ? job.files.pairs : "", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  return {gatherValues(job.ranks, bytes)[0], false};
}

/// What a person may look at, and what a run with other hints starts from.
void writeRegistration(const Job& job, const ScanRegistrationResult& result, const ScanRegistrationOptions& options,
                       const PairMemory& memory)
{
  if (job.ranks.rank() > 0)
    return;
  if (!memory.used)
    writeFile(job.files.pairs, memory.bytes);
  writeFile(job.files.registration_json, registrationJson(result, options));
  writeFile(job.files.registration_html, registrationPage(result, options));
}

/// World from scan. Without -use_poses all scans are registered from scratch, as they were measured: what cleaning takes
/// from a sparse scan is what its place would be known by. The folder's first pose then only ties the result to the
/// frame of the photographs. Where only some scans have poses, these are start poses.
std::vector<Pose> placeScans(const Job& job, const Progress& progress, Figures& figures)
{
  const auto& [input, files, options, stages, ranks] = job;
  if (options.use_poses) {
    figures["registration"] = "given poses";
    return input.poses;
  }
  ScanRegistrationOptions registration = stages.registration;
  for (const ScanPath& scan : input.scans)
    registration.names.push_back(scan.name());
  if (!options.hints.empty())
    registration.hints = readHints(options.hints, registration.names);
  const Index count = input.scans.size();
  ScanSource scans{count, [&, &paths = input.scans](Index i) { return readPoints(paths[i]); }};
  PairMemory memory = pairMemory(job);
  scans.ranks = &ranks;
  scans.memory = &memory;
  const bool partial = isPartial(input.poses);
  const ScanRegistrationResult result =
      registerScans(scans, partial ? input.poses : std::vector<Pose>(), registration, progress);
  writeRegistration(job, result, registration, memory);
  std::vector<Pose> poses = result.poses;
  figures["registration"] = partial ? "found, from some given poses" : "found";
  figures["registration_page"] = fs::path(files.registration_html).filename().string();
  figures["registration_rms"] = result.rms;
  figures["warnings"] = registrationWarnings(result, registration);
  Index tie = 0;
  while (tie < count && !poses[tie])
    ++tie;
  if (tie == count)
    throw std::runtime_error(registration.names[0] + ": " + result.scans[0].problem + "; no scan could be placed");
  if (!partial && !input.poses.empty() && input.poses[tie]) {
    const Eigen::Matrix4d T_world_group = *input.poses[tie] * poses[tie]->inverse();
    for (Pose& pose : poses)
      if (pose)
        pose = T_world_group * *pose;
  }
  return poses;
}

/// What is counted over the scans that have a place.
struct ScanCounts {
  std::int64_t read = 0, raw = 0, written = 0, points = 0, colored = 0, with_intensities = 0;
};

/// Writes the scans with a place, each rank its own, into an empty folder.
ScanCounts writeScans(const Job& job, const std::vector<Pose>& poses, const Progress& progress)
{
  ScanCounts counts;
  const Index count = job.input.scans.size();
  const double step = 1.0 / static_cast<double>(count);
  const auto prepared = [&](Index s) {
    report(progress, concat("scan ", s + 1, " of ", count), step * s);
    PointSet scan = readPoints(job.input.scans[s]);
    counts.raw += scan.size();
    ++counts.read;
    counts.colored += scan.colors.cols() > 0;
    counts.with_intensities += scan.intensities.size() > 0;
    return preparedScan(std::move(scan), job, subProgress(progress, step * s, step * (s + 1)));
  };
  const PlacedPoints placed(job.files.points);
  if (job.ranks.rank() == 0)
    placed.clear();
  awaitAll(job.ranks);
  const auto keep = [&](Index s, const PointSet& scan) {
    ++counts.written;
    counts.points += scan.size();
    placed.write(s, scan);
  };
  ScanSource scans{count, prepared};
  scans.ranks = &job.ranks;
  forEachPlacedScan(scans, poses, keep, job.options.threads);
  std::array<std::int64_t, 6> all{counts.read,   counts.raw,     counts.written,
                                  counts.points, counts.colored, counts.with_intensities};
  job.ranks.sum(all.data(), all.size()); // all files are there, too
  if (job.ranks.rank() == 0)
    placed.await(all[2]);
  return {all[0], all[1], all[2], all[3], all[4], all[5]};
}

Figures pointsFromScans(const Job& job, const Progress& progress)
{
  Figures figures;
  std::vector<Pose> poses = placeScans(job, subProgress(progress, 0.0, 0.4), figures);
  poses = gatherValues(job.ranks, poses)[0];
  const ScanCounts counts = writeScans(job, poses, subProgress(progress, 0.4, 1.0));
  if (job.ranks.rank() > 0)
    return figures;
  writePoses(job.files.poses, poses);
  figures["scans"] = job.input.scans.size();
  figures["raw_points"] = counts.raw; // of the scans that have a place
  figures["points"] = counts.points;
  figures["unplaced_scans"] = std::count(poses.begin(), poses.end(), std::nullopt);
  for (const auto& [having, what] : {std::pair{counts.colored, "colours"}, {counts.with_intensities, "intensities"}})
    if (having > 0 && having < counts.read && !job.input.hasPictures())
      figures["warnings"].push_back(
          concat(what, " of ", having, " scans are not used: ", counts.read - having, " have none"));
  return figures;
}

/// How far poses were moved: the RMS of the shifts (metres) and of the turns (degrees).
std::pair<double, double> rmsMoves(const std::vector<Eigen::Isometry3d>& from, const std::vector<Eigen::Isometry3d>& to)
{
  double shift = 0, turn = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    shift += (to[i].translation() - from[i].translation()).squaredNorm() / from.size();
    turn += std::pow(Eigen::AngleAxisd(to[i].linear() * from[i].linear().transpose()).angle(), 2) / from.size();
  }
  return {std::sqrt(shift), std::sqrt(turn) * degrees_per_radian};
}

Figures pointsFromFrames(const Job& job, const Progress& progress)
{
  const auto& [input, files, options, stages, ranks] = job;
  Figures figures;
  std::vector<Pose> poses = input.poses; // of all frames; those of `rgbd` have one
  RgbdFolder rgbd = *input.rgbd;
  if (!rgbd.has_poses) {
    poses = trackFrames(job, figures, subProgress(progress, 0.0, 0.3));
    writePoses(files.poses, poses);
    rgbd.frames = placedFrames(job);
  }
  DepthFrames frames;
  frames.camera = rgbd.camera;
  for (const RgbdFrame& frame : rgbd.frames)
    frames.T_world_camera.push_back(frame.T_world_camera);
  DepthReader reader(rgbd, options.threads);
  frames.depth = [&](Index f) { return reader(f); };
  DepthFusionOptions fusion = stages.fusion;
  fusion.cell = options.fuse > 0 ? options.fuse : finestCell(job);
  fusion.refine_poses = !options.use_poses;
  const DepthFusionResult fused =
      fuseDepthImages(frames, fusion, subProgress(progress, rgbd.has_poses ? 0.0 : 0.3, 1.0));
  if (fused.points.size() < 100)
    throw std::runtime_error(input.folder + ": hardly any depth in the frames");
  // Smoothing of the normals would change nothing: docs/measurements/depth_fusion.md.
  const PointSet& points = fused.points;
  const PlacedPoints placed(files.points);
  placed.clear();
  placed.write(0, points);
  std::size_t next = 0;
  for (Pose& pose : poses)
    if (pose)
      pose = fused.T_world_camera.at(next++).matrix();
  writePoses(files.poses, poses);
  const auto [shift, turn] = rmsMoves(frames.T_world_camera, fused.T_world_camera);
  figures.update({{"registration", !rgbd.has_poses     ? "tracked, refined"
                                   : options.use_poses ? "given poses"
                                                       : "given poses, refined"},
                  {"frames", rgbd.frames.size()},
                  {"poses_moved_metres", shift},
                  {"poses_turned_degrees", turn},
                  {"fusion_cell", fusion.cell},
                  {"points", points.size()}});
  return figures;
}
} // namespace

double finestCell(const Job& job)
{
  // Finer cells follow the noise of single pixels: docs/measurements/depth_fusion.md.
  constexpr double pixels_per_cell = 3;
  constexpr double scans = 0.02; // metres: rooms from a few stations, some 1 to 10 mm between points
  if (job.options.cell > 0)
    return job.options.cell;
  if (job.input.is_cloud)
    return std::stod(readFile(job.files.cell));
  return job.input.rgbd ? pixels_per_cell * pixelFootprint(*job.input.rgbd) : scans;
}

Figures makePoints(const Job& job, const Progress& progress)
{
  Figures figures = job.input.rgbd       ? pointsFromFrames(job, progress)
                    : job.input.is_cloud ? pointsFromCloud(job, progress)
                                         : pointsFromScans(job, progress);
  for (const std::string& warning : job.input.warnings)
    figures["warnings"].push_back(warning);
  return figures;
}
} // namespace fresco::model
