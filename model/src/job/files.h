// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
namespace fresco::model {
/// Files that the chain writes into its folder; the ones in `work` are kept for resuming.
struct ModelFiles {
  std::string folder;
  std::string work = folder + "/work", snapshots = folder + "/snapshots";
  std::string points = work + "/points"; ///< a folder: PlacedPoints
  std::string cell = work + "/cell.txt"; ///< finest cell of a cloud, as its points ask for
  std::string video = work + "/video";   ///< frames of a video
  std::string surface = work + "/surface.ply", viewer_glb = work + "/viewer.glb";
  std::string places = work + "/places";           ///< small photographs for the report
  std::string pictures = work + "/pictures";       ///< unpacked from files of scans while they are needed
  std::string photographs = work + "/photographs"; ///< what the program colmap finds
  std::string cameras = work + "/cameras";         ///< of photographs, in the frame of the points
  std::string points_ply = folder + "/points.ply", surface_ply = folder + "/surface.ply"; ///< of a run that ends there
  std::string poses = folder + "/poses.txt", mesh = folder + "/mesh.ply";
  std::string model_obj = folder + "/model.obj", model_glb = folder + "/model.glb";
  std::string full_glb = folder + "/model_full.glb", tiles = folder + "/tiles";
  std::string pairs = work + "/pairs.bin"; ///< what the search of pairs of scans found
  std::string registration_json = folder + "/registration.json", registration_html = folder + "/registration.html";
  std::string report_json = folder + "/report.json", report_html = folder + "/report.html";
};

/// What a run may be asked to end with, as ModelOptions::until has it, the last stage that this needs, and what is handed over.
struct RunEnd {
  const char *until, *stage;
  std::string ModelFiles::*file;
};
inline constexpr RunEnd run_ends[] = {{"points", "points", &ModelFiles::points_ply},
                                      {"surface", "surface", &ModelFiles::surface_ply},
                                      {"mesh", "optimization", &ModelFiles::mesh},
                                      {"", "pictures", &ModelFiles::report_html}};
} // namespace fresco::model
