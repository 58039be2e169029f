// SPDX-License-Identifier: BSD-3-Clause
#include "photographs/structure_from_motion.h"
#include "stages/placed_points.h"
#include "stages/stages.h"
#include <Eigen/Geometry>
#include <fresco/alignment/core/camera_alignment.h>
#include <fresco/core/constants.h>
#include <fresco/io/colmap.h>
#include <fresco/io/image_io.h>
namespace fresco::model {
namespace {
StructureFromMotion structureFromMotion(const Job& job)
{
  return {job.input.images, job.input.unplaced, job.files.photographs, job.options.threads};
}
} // namespace

Figures findFeatures(const Job& job, const Progress& progress)
{
  structureFromMotion(job).findFeatures(progress);
  return {{"photographs", job.input.unplaced.size()}};
}

Figures matchFeatures(const Job& job, const Progress& progress)
{
  structureFromMotion(job).matchFeatures(progress);
  return Figures::object();
}

Figures findCameras(const Job& job, const Progress& progress)
{
  const StructureFromMotion motion = structureFromMotion(job);
  const std::vector<std::string> warnings = motion.findCameras(progress);
  return {{"photographs", job.input.unplaced.size()},
          {"photographs_with_cameras", readColmap(motion.model()).views.size()},
          {"warnings", warnings}};
}

Figures alignCameras(const Job& job, const Progress& progress)
{
  const bool found = !job.input.unplaced.empty();
  const std::string folder = found ? structureFromMotion(job).model() : job.input.camera_folder;
  CameraSet set = found ? readColmap(folder) : job.input.cameras;
  SparsePoints points = found ? readColmapPoints(folder) : job.input.sparse;
  Figures figures;
  if (!found && points.size() < fewest_sparse_points) {
    figures = {
        {"frame", "taken as that of the scans"},
        {"warnings", {"the cameras' model has too few points to tell its frame: it is taken as that of the scans"}}};
    writeColmap(job.files.cameras, set, points);
    return figures;
  }
  constexpr Index most_points = 5000000; // the search takes far fewer, and drawings of 24 places hardly show more
  CameraAlignmentOptions options = job.stages.alignment;
  options.photograph = [&](Index view) {
    return readImage(job.input.images + "/" + set.views[view].image, set.cameras[set.views[view].camera]);
  };
  CameraAlignmentResult result;
  try {
    result = fresco::alignCameras(set, points, PlacedPoints(job.files.points).sample(most_points), options, progress);
  } catch (const Cancelled&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(folder + ": " + error.what());
  }
  const Similarity& T = result.T_scans_cameras;
  transformCameras(T, set, points);
  writeColmap(job.files.cameras, set, points);
  return {{"frame", result.already_aligned ? "that of the scans already" : "found"},
          {"photographs", set.views.size()},
          {"scale", T.scale},
          {"turned_degrees", Eigen::AngleAxisd(T.R).angle() * degrees_per_radian},
          {"matches", result.matches},
          {"support", result.support},
          {"blocked", result.blocked},
          {"next_best", result.alias},
          {"rms", result.rms}};
}

SparsePoints foundPoints(const Job& job)
{
  return job.input.findsCameras() ? readColmapPoints(structureFromMotion(job).model()) : job.input.sparse;
}

CameraSet placedCameras(const Job& job)
{
  if (job.input.alignsCameras())
    return readColmap(job.files.cameras);
  return job.input.findsCameras() ? readColmap(structureFromMotion(job).model()) : job.input.cameras;
}
} // namespace fresco::model
