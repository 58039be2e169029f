// SPDX-License-Identifier: BSD-3-Clause
// Project folder of COLMAP (Schoenberger & Frahm 2016): images/, sparse/0/, and where stereo was run dense/fused.ply.
#include "input/parts.h"
#include <fresco/core/require.h>
#include <fresco/io/colmap.h>
namespace fresco::model {
namespace {
/// Folder of the model with most photographs: sparse/ itself or one below.
std::string largestModel(const Survey& found, const std::string& folder)
{
  std::string best;
  std::size_t most = 0;
  for (const std::string& place : {folder, folder + "/*"})
    for (const char* kind : {"/cameras.txt", "/cameras.bin"})
      for (const std::string& name : found.match(place + kind)) {
        const std::string model = found.at(name.substr(0, name.rfind('/')));
        if (const std::size_t views = readColmap(model).views.size(); views > most) {
          most = views;
          best = model;
        }
      }
  if (best.empty())
    throw std::runtime_error(found.at(folder) +
                             ": no COLMAP model with photographs (cameras, images as .txt or .bin) in it: run "
                             "colmap mapper");
  return best;
}
} // namespace

void readColmapProject(const Survey& found, std::optional<Reading> asked, ModelInput& input)
{
  const std::string dense = found.has("dense/0/sparse/") ? "dense/0" : "dense";
  const bool undistorted = found.has(dense + "/images/") && found.has(dense + "/sparse/");
  const std::string top = undistorted ? dense + "/" : "";
  const std::vector<std::string> cloud = found.match(dense + "/fused.ply|fused.ply|*.ply");
  input.camera_folder = largestModel(found, top + "sparse");
  takeCameras(input, found, input.camera_folder, top + "images");
  if (asked != Reading::photographs && !cloud.empty()) {
    input.scans = {{found.at(cloud[0])}};
    input.sparse.clear(); // cameras and points have one frame
    takeAsCloud(input, found);
  } else {
    input.is_cloud = true;
    input.warnings.push_back(roughOnly());
  }
}
} // namespace fresco::model
