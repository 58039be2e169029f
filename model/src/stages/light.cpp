// SPDX-License-Identifier: BSD-3-Clause
#include "stages/stages.h"
#include <filesystem>
#include <fresco/deliverables/core/detail_baking.h>
#include <fresco/deliverables/core/model_file.h>
#include <fresco/deliverables/core/tileset.h>
#include <numeric>
namespace fresco::model {
namespace {
/// The model inside of the report: without normal maps, which a viewer that lights nothing does not need, and with coarser
/// pictures until it is small enough for a mail.
void writeViewerModel(GltfModel light, GltfOptions options, const std::string& path)
{
  constexpr std::uintmax_t most_bytes = 5000000; // 6.7 MB as text, which leaves the rest of the page 3.3 MB of 10
  constexpr int smallest = 256;                  // pixels; then the shape itself is large
  options.jpeg_quality = 80;                     // for a view on the screen; model.glb has what is handed over
  light.normal_maps.clear();
  light.model.mesh.normals.resize(3, 0);
  const auto longest = [](int side, const Image& image) { return std::max({side, image.width, image.height}); };
  const std::vector<Image>& atlases = light.model.atlases;
  for (writeGltf(path, light, options); std::filesystem::file_size(path) > most_bytes &&
                                        std::accumulate(atlases.begin(), atlases.end(), 0, longest) > smallest;
       writeGltf(path, light, options))
    for (Image& image : light.model.atlases)
      image = halfSize(image);
}
} // namespace

Figures makeLight(const Job& job, const Progress& progress)
{
  constexpr int quality = 90; // of JPEG: what it loses is below what photographs differ by from each other
  report(progress, "reading the full model", 0.0);
  const TexturedMesh full = readModel(job.files.full_glb).model;
  LightModelOptions options;
  options.faces = job.options.faces;
  options.threads = job.options.threads;
  GltfModel light = makeLightModel(full, options, subProgress(progress, 0.1, 0.9));
  GltfOptions gltf;
  gltf.jpeg_quality = quality;
  gltf.compact = true;
  gltf.lit = !isColored(full);
  gltf.compress = job.options.compress;
  report(progress, "writing", 0.9);
  writeGltf(job.files.model_glb, light, gltf);
  const Figures figures = {{"faces", light.model.mesh.faceCount()},
                           {"faces_of_full_model", full.mesh.faceCount()},
                           {"atlases", light.model.atlases.size()},
                           {"atlas_width", light.model.atlases[0].width},
                           {"texel", typicalTexel(light.model)},
                           {"megabytes", 1e-6 * std::filesystem::file_size(job.files.model_glb)},
                           {"megabytes_of_full_model", 1e-6 * std::filesystem::file_size(job.files.full_glb)}};
  gltf.compress = false; // the viewer has no decoder
  writeViewerModel(std::move(light), gltf, job.files.viewer_glb);
  return figures;
}

Figures makeTiles(const Job& job, const Progress& progress)
{
  const std::string& folder = job.files.tiles;
  std::filesystem::remove_all(folder); // an earlier run may have left more of them
  TilesetOptions options;
  options.threads = job.options.threads;
  const std::vector<Tile> tiles = writeTileset(folder, readModel(job.files.full_glb).model, options, progress);
  const auto megabytes = [&](const std::string& file) {
    return 1e-6 * std::filesystem::file_size(folder + "/" + file);
  };
  double all = megabytes("tileset.json");
  const double first = all + megabytes(tiles[0].file);
  int depth = 0;
  for (const Tile& tile : tiles) {
    all += megabytes(tile.file);
    depth = std::max(depth, tile.depth);
  }
  return {{"tiles", tiles.size()}, {"levels", depth + 1}, {"megabytes", all}, {"megabytes_of_first_view", first}};
}
} // namespace fresco::model
