// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "input/model_input.h"
#include "job/files.h"
#include "stages/stage_options.h"
#include <fresco/core/progress.h>
#include <fresco/model/build_model.h>
#include <nlohmann/json.hpp>
namespace fresco::model {
/// What a stage found, by name; goes into the report.
using Figures = nlohmann::ordered_json;

/// What all stages of a job share.
struct Job {
  ModelInput input;
  ModelFiles files;
  ModelOptions options;
  StageOptions stages;
  Exchange& ranks; ///< that make the points of scans together
};

/// Finest cell of the surface, metres: ModelOptions::cell, or what the data sustain. Of a cloud: reads `files.cell`.
double finestCell(const Job& job);

/// All scans or frames in one frame with normals: reads the input, writes `files.points` and `files.poses`.
Figures makePoints(const Job& job, const Progress& progress);

/// The points of a cloud with normals to the free side, in its own frame: writes `files.points`, `files.poses`, `files.cell`.
Figures pointsFromCloud(const Job& job, const Progress& progress);

/// Cameras of photographs that have none, by the program colmap, in three steps that leave their files in
/// `files.photographs`.
Figures findFeatures(const Job& job, const Progress& progress);
Figures matchFeatures(const Job& job, const Progress& progress);
Figures findCameras(const Job& job, const Progress& progress);

/// Brings the cameras of photographs into the frame of `files.points`, unless they stand in it: writes `files.cameras`.
Figures alignCameras(const Job& job, const Progress& progress);

/// What structure from motion found of the photographs, in the frame of placedCameras() where there are no scans.
SparsePoints foundPoints(const Job& job);

/// The photographs' cameras in the frame of the points.
CameraSet placedCameras(const Job& job);
/// RGB-D frames that have a pose, with it: as given, or as tracking found it (reads `files.poses`).
std::vector<RgbdFrame> placedFrames(const Job& job);

/// Poses of RGB-D frames without any, one a frame; adds figures and warnings.
std::vector<Pose> trackFrames(const Job& job, Figures& figures, const Progress& progress);

/// Surface of the points: reads `files.points`, writes `files.surface`. Unless it is to be closed, the surface in
/// places that scans or frames saw through is left out.
Figures makeSurface(const Job& job, const Progress& progress);

/// Sharp edges: reads `files.surface` and `files.points`, writes `files.mesh`. Without ModelOptions::optimize the
/// surface is taken as it is.
Figures makeOptimizedSurface(const Job& job, const Progress& progress);

/// Texture from photographs and panoramas, else from the points: reads `files.mesh`, writes the model and the masks.
Figures makeTexture(const Job& job, const Progress& progress);

/// The model as it is handed over: reads `files.full_glb`, writes `files.model_glb`, of fewer faces, with a normal map,
/// and `files.viewer_glb`, smaller still.
Figures makeLight(const Job& job, const Progress& progress);

/// The full model in parts for a browser: reads `files.full_glb`, writes into `files.tiles`.
Figures makeTiles(const Job& job, const Progress& progress);

/// Pictures of the model from inside and above: reads `files.model_obj`, writes PNG files into `files.snapshots`.
/// @return with an array "pictures" of {file, title, textured, eye, look, angle} and the upright direction "up"
Figures makePictures(const Job& job, const Progress& progress);

/// The files that makePictures() writes.
std::vector<std::string> pictureFiles(const Job& job);
} // namespace fresco::model
