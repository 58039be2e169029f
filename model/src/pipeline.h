// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "input.h"
#include "stage_log.h"
#include <fresco/core/progress.h>
#include <string>
#include <vector>
namespace fresco::model {
/// Lengths in metres.
struct ModelOptions {
  bool resume = false;            ///< go on after the last stage that an earlier run finished
  bool use_poses = false;         ///< take the folder's poses.txt as they are; RGB-D frames always bring theirs
  double cell = 0.02;             ///< finest cell of the reconstruction, > 0
  double fuse = 0.01;             ///< RGB-D: cell in which points of all frames are averaged, > 0
  int bilateral = 2;              ///< rounds of bilateral smoothing of the normals, >= 0
  bool optimize = true;           ///< move the vertices so that edges become sharp
  double trim = 2.0;              ///< see VolumetricOptions::trim_levels; 0 = keep it closed
  double texel = 0.0;             ///< side of a texel; 0 = from the photographs
  int width = 1280, height = 960; ///< of the pictures, pixels
  int threads = 0;                ///< 0 = all cores; the result does not depend on it
};

/// Files that the job writes into its folder; the ones in `work` are kept for resuming.
struct ModelFiles {
  explicit ModelFiles(const std::string& folder);
  std::string folder, work, snapshots, points, surface, poses, mesh, model_obj, model_glb, viewer_glb, report_json,
      report_html;

  /// Mask `index` of `count`: white where no photograph saw the surface.
  std::string mask(std::size_t index, std::size_t count) const;
};

/// A picture of the model and where it was taken from, world coordinates.
struct ModelPicture {
  std::string file; ///< relative to the folder
  std::string title;
  bool textured = false;
  Eigen::Vector3d eye = Eigen::Vector3d::Zero(), look = Eigen::Vector3d::Zero();
  double angle = 0; ///< vertical opening angle, degrees; 0 = not known
};

struct ModelReport {
  std::string input;
  std::vector<StageRecord> stages;
  std::vector<ModelPicture> pictures;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ(); ///< upright direction
  double seconds = 0;                            ///< of this run
};

/// The whole chain from an input folder to the textured model: points and normals, poses, mesh, sharp edges, texture,
/// pictures.
/// Stages hand over files, so a resumed run gives the same bytes as an undisturbed one.
/// @throws std::runtime_error naming file and reason; what earlier stages wrote stays
ModelReport buildModel(const ModelInput& input, const std::string& folder, const ModelOptions& options,
                       const Progress& progress);
} // namespace fresco::model
