// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/progress.h>
#include <string>
#include <utility>
#include <vector>
namespace fresco {
class Exchange;

/// Options of buildModel(). Lengths in metres.
struct ModelOptions {
  bool resume = false;    ///< go on after the last stage that an earlier run finished
  std::string taken_as;   ///< what the input is taken for: scans, cloud, rgbd, photographs; "" = what it looks like
  double depth_unit = 0;  ///< metres a unit of 16-bit depth images stands for, >= 0; 0 = as the layout has it
  std::string until;      ///< stop once that is written: points (points.ply), surface (surface.ply) or mesh (mesh.ply);
                          ///< "" = the whole model. A later run with `resume` goes on from there
  bool use_poses = false; ///< take the poses of scans (poses.txt) or of RGB-D frames as they are
  std::string hints;      ///< file that tells what is known of the places of scans, see readHints(); "" = none
  double cell = 0;        ///< finest cell of the surface reconstruction, >= 0; 0 = 0.02 for scans, three pixels
                          ///< at the median depth for RGB-D
  double fuse = 0;        ///< RGB-D: cell in which the frames are fused, >= 0; 0 = as `cell`
  int bilateral = 2;      ///< rounds of bilateral smoothing of the normals of scans, >= 0
  bool optimize = true;   ///< move the vertices so that edges become sharp; scans only
  double trim_levels = 2.0;      ///< >= 0; 0 = keep the surface closed. Scans: it is cut where none saw it, but gaps of
                                 ///< 4 x 4 cells so many octree levels coarser stay closed. RGB-D: see
                                 ///< VolumetricOptions::trim_levels, at most 0.75
  double texel = 0.0;            ///< side of a texel, >= 0; 0 = as fine as photographs, panoramas or points
  int atlas = 0;                 ///< largest side of a picture of the texture, 128..16384 pixels, more of them beyond;
                                 ///< 0 = 8192
  int tile_faces = 0;            ///< most faces that are textured at a time; 0 = all, or as many as memory holds
  int faces = 100000;            ///< most faces of model.glb, the light model, >= 1
  bool lod = false;              ///< also tiles/tileset.json: the full model as 3D Tiles, see TilesetOptions
  bool compress = false;         ///< model.glb: see GltfOptions::compress
  int quality = 0;               ///< JPEG quality of the texture's pictures, 1..100; 0 = PNG
  double panorama_direction = 0; ///< degrees counter-clockwise from the scan's x axis to the middle of its panorama
  bool panorama_mirrored = false; ///< panoramas go around counter-clockwise from left to right
  int width = 1280, height = 960; ///< of the pictures, pixels, at least 160 x 120
  /// Options of the stages' own tools: {"reconstruct.depth", "10"}, {"texture.refine", "0"}; see StageOptions. What the others
  /// here set comes from these.
  std::vector<std::pair<std::string, std::string>> stage_options;
  int threads = 0; ///< 0 = all cores; the result does not depend on it
};

/// What one stage cost and what it found.
struct ModelStage {
  std::string name;   ///< points, surface, optimization, features, matches, cameras, alignment, texture, light, tiles,
                      ///< pictures
  double seconds = 0; ///< wall clock
  double cpu_seconds = 0;    ///< of all threads, and of programs that were run
  double peak_megabytes = 0; ///< resident memory of the process, highest during the stage
  bool resumed = false;      ///< taken over from an earlier run
  /// Name and value, numbers with four digits, lists as JSON; report.json has them in full.
  std::vector<std::pair<std::string, std::string>> figures;
  std::vector<std::string> warnings; ///< what was left out or ignored, a sentence each
};

struct ModelReport {
  std::string input;                 ///< see describeInput()
  std::vector<ModelStage> stages;    ///< in the order in which they ran
  std::vector<std::string> pictures; ///< files, relative to the output folder
  double seconds = 0;                ///< wall clock of this run
};

/// The whole chain from a folder of measurements to a textured model: points with normals, registration, surface
/// reconstruction, sharp edges, texture, pictures and a report.
///
/// Stages hand over files, so a resumed run gives the same bytes as an undisturbed one. Every file is written whole or
/// not at all. Written are model.obj with .mtl and .png, model_full.glb, model.glb of fewer faces, model_mask.png, mesh.ply, poses.txt,
/// snapshots/*.png, report.html, report.json, and in work/ what `resume` needs.
/// @param input_folder  scans or a cloud, with or without photographs, or RGB-D frames, in any of the layouts of docs/inputs.md; or a file
/// @param output_folder made where it is missing
/// @param progress      hears "STAGE: STEP" and the share of the stage
/// @throws std::invalid_argument if an option is out of range
/// @throws std::runtime_error naming file and reason: an input that is missing or damaged, an output that cannot be
///                            written. What earlier stages wrote stays
/// @throws Cancelled if `progress` asks to stop
FRESCO_EXPORT ModelReport buildModel(const std::string& input_folder, const std::string& output_folder,
                                     const ModelOptions& options = {}, const Progress& progress = {});

/// Both as buildModel() takes them.
struct ModelFolders {
  std::string input, output;
};

/// The same by several ranks, which must see the same folders: the scans are shared out when they are cleaned, get their
/// normals and are registered. All else is made by rank 0. The same files come out.
/// @return nothing on other ranks than 0
/// @throws as above, also on one rank alone
FRESCO_EXPORT ModelReport buildModel(const ModelFolders& folders, const ModelOptions& options, const Progress& progress,
                                     Exchange& ranks);

/// What kind of input a folder or file is: "6 scans, 60 photographs".
/// @throws std::runtime_error as buildModel()
FRESCO_EXPORT std::string describeInput(const std::string& input_folder);

/// What buildModel() would do. Numbers are true to a factor of about two.
struct ModelPlan {
  std::string input;                 ///< see describeInput()
  std::vector<std::string> found;    ///< a line for each thing in the input and what it is taken for
  std::vector<std::string> warnings; ///< what is left out, a sentence each
  std::vector<std::string> stages;   ///< in their order
  double points = 0;                 ///< raw, as the files announce
  double seconds = 0;                ///< wall clock
  double most_seconds = 0;           ///< the same where photographs are to be placed that hardly overlap
  double memory = 0, disk = 0;       ///< bytes
};

/// Looks at the input and writes nothing. @throws as buildModel() for what it finds before its first stage
FRESCO_EXPORT ModelPlan planModel(const ModelFolders& folders, const ModelOptions& options = {});

/// "points, surface, texture; 876,000 points; about 3 min, 900 MB of memory, 120 MB of disk"; "3 to 6 min" where photographs are
/// to be placed.
FRESCO_EXPORT std::string planSummary(const ModelPlan& plan);

/// One line with time, memory and figures of a stage.
FRESCO_EXPORT std::string stageSummary(const ModelStage& stage);
} // namespace fresco
