// SPDX-License-Identifier: BSD-3-Clause
#include "job/stage_log.h"
#include "photographs/structure_from_motion.h"
#include "plan.h"
#include "report/report.h"
#include "stages/placed_points.h"
#include "stages/stages.h"
#include "stages/video.h"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/files_read.h>
#include <fresco/io/reading.h>
#include <fresco/io/shared_files.h>
namespace fresco {
namespace {
using namespace model;

void validate(const ModelInput& input, const ModelOptions& options)
{
  require(options.cell >= 0 && options.fuse >= 0, "model: a cell of ", options.cell, " m or ", options.fuse, " m");
  require(options.depth_unit >= 0, "model: a unit of depth of ", options.depth_unit, " m");
  require(options.bilateral >= 0 && options.trim_levels >= 0 && options.texel >= 0, "model: an option is negative");
  require(options.atlas == 0 || (options.atlas >= 128 && options.atlas <= 16384), "model: atlas ", options.atlas,
          " is neither 0 nor in 128..16384");
  require(options.faces >= 1, "model: ", options.faces, " faces of the light model");
  require(options.tile_faces >= 0, "model: ", options.tile_faces, " faces of a tile");
  require(options.quality >= 0 && options.quality <= 100, "model: quality ", options.quality, " is not in 0..100");
  require(options.width >= 160 && options.height >= 120, "model: pictures of ", options.width, "x", options.height,
          " pixels are too small");
  if (options.use_poses && input.poses.empty())
    throw std::runtime_error(input.folder + "/poses.txt: no such file, but its poses are asked for");
  require(std::abs(options.panorama_direction) <= 360, "model: a panorama's direction of ", options.panorama_direction,
          " degrees");
}

std::string lastStage(const ModelOptions& options)
{
  for (const RunEnd& end : run_ends)
    if (options.until == end.until)
      return end.stage;
  throw std::invalid_argument("model: -until " + options.until + " is none of points, surface, mesh");
}

/// Whether pictures are looked at: of scans only where there is to be a texture.
bool usesPictures(const Job& job) { return job.options.until.empty() || job.input.rgbd || job.input.scans.empty(); }

/// @throws std::runtime_error naming the program that is not installed
void requirePrograms(const Job& job)
{
  const ModelInput& input = job.input;
  if (input.findsCameras() && usesPictures(job))
    requireStructureFromMotion(input.images.empty() ? input.folder : input.images, input.unplaced.size());
  if (!input.video.empty())
    requireVideoProgram(input.video);
}

/// The steps of the chain, each with the options that its outputs depend on besides the steps before it.
std::vector<Stage> stagesOf(const Job& job)
{
  const ModelInput& input = job.input;
  const ModelFiles& files = job.files;
  const ModelOptions& options = job.options;
  std::vector<Stage> stages;
  const auto add = [&](const char* name, const std::string& own, std::vector<std::string> outputs,
                       Figures (*make)(const Job&, const Progress&), const std::vector<std::string>& tools = {}) {
    std::string all = own;
    for (const auto& [option, value] : options.stage_options)
      if (std::find(tools.begin(), tools.end(), option.substr(0, option.find('.'))) != tools.end())
        all += concat(" ", option, " ", value);
    stages.push_back(
        {name, all, std::move(outputs), [&job, make](const Progress& progress) { return make(job, progress); }});
  };
  const auto addCameras = [&] {
    const StructureFromMotion motion(input.images, input.unplaced, files.photographs, options.threads);
    if (!input.findsCameras())
      return;
    add("features", "", {motion.database()}, findFeatures);
    add("matches", "", {motion.database()}, matchFeatures);
    add("cameras", "", {motion.model() + "/points3D.txt"}, findCameras);
  };
  if (input.scans.empty()) // the cameras' points are all there is
    addCameras();
  std::string columns; // of clouds that are text
  for (const std::string& name : textColumns())
    columns += " " + (name.empty() ? "-" : name);
  std::vector<std::string> of_points{files.points, files.poses};
  if (input.is_cloud)
    of_points.push_back(files.cell);
  add("points",
      concat(options.use_poses, " ", options.hints, " ", options.depth_unit, " ", options.fuse, " ",
             options.fuse > 0 ? 0.0 : options.cell, " ", options.bilateral, columns),
      of_points, makePoints, {"register", "filter", "normals", "fuse", "track"});
  stages.back().shared = !input.rgbd && !input.is_cloud;
  add("surface", concat(options.cell, " ", options.trim_levels), {files.surface}, makeSurface, {"reconstruct"});
  add("optimization", concat(options.optimize), {files.mesh}, makeOptimizedSurface, {"optimize"});
  if (!input.scans.empty())
    addCameras();
  if (input.alignsCameras())
    add("alignment", "", {files.cameras + "/images.txt"}, model::alignCameras, {"align"});
  add("texture",
      concat(options.texel, " ", options.atlas, " ", options.quality, " ", options.panorama_direction, " ",
             options.panorama_mirrored, " ", options.tile_faces),
      {files.model_obj, files.full_glb}, makeTexture, {"texture"});
  add("light", concat(options.faces, " ", options.compress), {files.model_glb, files.viewer_glb}, makeLight);
  if (options.lod)
    add("tiles", "", {files.tiles}, makeTiles);
  add("pictures", concat(options.width, "x", options.height), pictureFiles(job), makePictures);
  const std::string last = lastStage(options);
  stages.erase(std::find_if(stages.begin(), stages.end(), [&](const Stage& stage) { return stage.name == last; }) + 1,
               stages.end());
  return stages;
}

/// @throws std::invalid_argument for wrong options of stages, before anything is read
Job jobOf(const ModelFolders& folders, const ModelOptions& options, Exchange& ranks)
{
  const StageOptions stages(options.threads, options.stage_options);
  return {readModelInput(folders.input, options.taken_as, options.depth_unit), ModelFiles{folders.output}, options,
          stages, ranks};
}

/// What a run that ends early was asked for, as a file of its own.
void deliver(const Job& job)
{
  const ModelFiles& files = job.files;
  if (job.options.until == "points")
    PlacedPoints(files.points).writePly(files.points_ply);
  if (job.options.until != "surface")
    return;
  OutputFile file(files.surface_ply);
  std::filesystem::copy_file(files.surface, file.temporaryPath(), std::filesystem::copy_options::overwrite_existing);
  file.commit();
}
} // namespace

ModelReport buildModel(const std::string& input_folder, const std::string& output_folder, const ModelOptions& options,
                       const Progress& progress)
{
  Exchange alone;
  return buildModel({input_folder, output_folder}, options, progress, alone);
}

ModelReport buildModel(const ModelFolders& folders, const ModelOptions& options, const Progress& progress,
                       Exchange& ranks)
{
  Job job = jobOf(folders, options, ranks);
  requireSameFiles(job.input.files(), folders.input, ranks);
  if (ranks.rank() > 0) {
    followStages(stagesOf(job), ranks, progress);
    return {};
  }
  validate(job.input, options);
  requirePrograms(job);
  requireRoom(estimate(job), job);
  const auto start = std::chrono::steady_clock::now();
  report(progress, "photographs", 0.0);
  if (usesPictures(job))
    checkPhotographs(job.input, options.threads);
  makeFolder(job.files.work);
  const FolderLock lock(job.files.work, "fresco_model");
  makeFolder(job.files.snapshots);
  std::vector<std::string> inputs = job.input.files();
  for (const std::string& file : filesRead())
    inputs.push_back(file);
  StageLog log(job.files.work, inputs, options.resume, progress);
  log.shareWith(ranks);
  if (!job.input.video.empty()) {
    log.run({"video", "", {job.files.video}, [&](const Progress& step) {
               return takeVideoFrames(job.input, job.files, options.threads, step);
             }});
    useVideoFrames(job.input, job.files.video);
  }
  for (const Stage& stage : stagesOf(job))
    log.run(stage);
  deliver(job);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  Report report = makeReport(folders.input, log.records(), seconds);
  report.kind = describe(job.input);
  writeReport(report, job.files);
  return publicReport(report);
}

ModelPlan planModel(const ModelFolders& folders, const ModelOptions& options)
{
  Exchange alone;
  const Job job = jobOf(folders, options, alone);
  validate(job.input, options);
  ModelPlan plan = estimate(job);
  requireRoom(plan, job);
  try {
    requirePrograms(job);
  } catch (const std::runtime_error& error) {
    plan.warnings.emplace_back(error.what());
  }
  if (!job.input.video.empty())
    plan.stages = {"video"};
  for (const Stage& stage : stagesOf(job))
    plan.stages.push_back(stage.name);
  return plan;
}

std::string describeInput(const std::string& input_folder) { return describe(readModelInput(input_folder)); }
} // namespace fresco
