// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline.h"
#include "optimization_stage.h"
#include "pictures_stage.h"
#include "points_stage.h"
#include "report.h"
#include "surface_stage.h"
#include "texture_stage.h"
#include <chrono>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
namespace fresco::model {
namespace {
void validate(const ModelInput& input, const ModelOptions& options)
{
  require(options.cell > 0 && options.fuse > 0, "model: a cell of ", options.cell, " m or ", options.fuse, " m");
  require(options.bilateral >= 0 && options.trim >= 0 && options.texel >= 0, "model: an option is negative");
  require(options.width >= 160 && options.height >= 120, "model: pictures of ", options.width, "x", options.height,
          " pixels are too small");
  if (options.use_poses && input.poses.empty())
    throw std::runtime_error(input.folder + "/poses.txt: no such file, but -poses asks for it");
  if (!input.rgbd && input.cameras.views.empty())
    throw std::runtime_error(input.folder + "/cameras: no photographs, so there is nothing to texture the model with");
}

Eigen::Vector3d vectorOf(const nlohmann::ordered_json& object, const char* name)
{
  const auto values = object.value(name, std::vector<double>{0, 0, 1});
  return Eigen::Vector3d(values.at(0), values.at(1), values.at(2));
}

void takePictures(const nlohmann::ordered_json& figures, ModelReport& report)
{
  report.up = vectorOf(figures, "up");
  for (const auto& picture : figures["pictures"])
    report.pictures.push_back({picture.value("file", ""), picture.value("title", ""), picture.value("textured", false),
                               vectorOf(picture, "eye"), vectorOf(picture, "look"), picture.value("angle", 0.0)});
}
} // namespace

ModelFiles::ModelFiles(const std::string& out)
    : folder(out), work(out + "/work"), snapshots(out + "/snapshots"), points(work + "/registered.ply"),
      surface(work + "/surface.ply"), poses(out + "/poses.txt"), mesh(out + "/mesh.ply"), model_obj(out + "/model.obj"),
      model_glb(out + "/model.glb"), viewer_glb(work + "/viewer.glb"), report_json(out + "/report.json"),
      report_html(out + "/report.html")
{}

std::string ModelFiles::mask(std::size_t index, std::size_t count) const
{
  return folder + (count > 1 ? concat("/model_mask_", index, ".png") : "/model_mask.png");
}

ModelReport buildModel(const ModelInput& input, const std::string& folder, const ModelOptions& options,
                       const Progress& progress)
{
  validate(input, options);
  const auto start = std::chrono::steady_clock::now();
  const ModelFiles files(folder);
  makeFolder(files.folder);
  makeFolder(files.snapshots);
  StageLog log(files.work, fingerprint(input.files()) + fingerprint(programFiles()), options.resume, progress);
  log.run({"points",
           concat(options.use_poses, " ", options.fuse, " ", options.bilateral),
           {files.points, files.poses},
           [&](const Progress& inner) { return makePoints(input, files, options, inner); }});
  log.run({"surface", concat(options.cell, " ", options.trim), {files.surface}, [&](const Progress& inner) {
             return makeSurface(input, files, options, inner);
           }});
  log.run({"optimization", concat(options.optimize), {files.mesh}, [&](const Progress& inner) {
             return makeOptimizedSurface(files, options, inner);
           }});
  log.run({"texture",
           concat(options.texel),
           {files.model_obj, files.model_glb, files.viewer_glb},
           [&](const Progress& inner) { return makeTexture(input, files, options, inner); }});
  log.run({"pictures", concat(options.width, "x", options.height), pictureFiles(files),
           [&](const Progress& inner) { return makePictures(input, files, options, inner); }});
  ModelReport result;
  result.input = input.folder;
  result.stages = log.records();
  takePictures(result.stages.back().figures, result);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  writeReport(result, files);
  return result;
}
} // namespace fresco::model
