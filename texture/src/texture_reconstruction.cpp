// SPDX-License-Identifier: BSD-3-Clause
#include "cameras/camera_refinement.h"
#include "charts/given_layout.h"
#include "photographs/input_checks.h"
#include "tiles/photo_painting.h"
#include "tiles/tiled_texture.h"
#include "views/face_orientation.h"
#include "views/patch_visibility.h"
#include <algorithm>
#include <fresco/core/require.h>
#include <fresco/texture/core/texture_reconstruction.h>
#include <memory>
namespace fresco {
using namespace texture;
namespace {
/// @param given of which texture coordinates are kept, if there are any
TextureResult reconstruct(const TexturedMesh& given, const std::vector<TextureView>& views,
                          const TextureOptions& options, const Progress& progress)
{
  TextureResult result;
  TexturedMesh model = withoutDuplicates(given, result);
  const TriangleMesh& mesh = model.mesh;
  result.model = model;
  weld(result);
  Steps steps(progress, result);
  steps.begin("photographs", 0.0);
  const std::vector<ViewPart> parts = partsOf(views);
  PhotoStore photos(parts, std::size_t(options.memory) << 20);
  checkPhotos(photos, parts, options, result);

  steps.begin("camera refinement", 0.05);
  auto rays = std::make_unique<RayScene>(result.model.mesh);
  placeCameras({mesh, *rays, parts, photos}, options, subProgress(progress, 0.05, 0.25), result);

  const std::vector<Projector> projectors = projectorsOf(mesh, parts, result.cameras);
  std::vector<char> inside_out;
  if (sameUnits(mesh, views))
    inside_out = insideOutFaces(result.model.mesh, *rays, projectors, result);
  for (TexturedMesh* m : {&model, &result.model})
    turnFaces(inside_out, *m);
  warnOfMisfits(parts, result);
  const ViewList list = viewList(projectors, photos, parts, result);
  const Job job{options, list, steps, result};
  ViewChoice choice;
  const VisibilityInput input{rays.get(), list, options};
  steps.begin("visibility", 0.25);
  choice.surface = findVisibleSurface(result.model.mesh, input, subProgress(progress, 0.25, 0.4));
  steps.begin("exposure", 0.4);
  choice.photometry = findPhotometry(choice.surface.candidates, job);
  steps.begin("view selection", 0.4);
  compareViews(input, choice);
  chooseViews(options, options.smoothness * diagonalOf(result.model.mesh), choice);
  rays.reset(); // painting needs the memory
  paintModel(job, choice, {mesh.faceCount(), choice.surface.patches.size(), blendRounds(job, choice)});
  warnOfLittleSeen(result.coverage, views, result);
  result.model.mesh.faces = mesh.faces;
  steps.begin("done", 1.0);
  return result;
}

MemoryNeed memoryNeed(const std::vector<TextureView>& views, const TextureOptions& options)
{
  constexpr std::size_t pixel = 4; // bytes: decoded and as a grey copy
  std::size_t photographs = 0;
  for (const TextureView& view : views)
    photographs += pixel * view.camera.width * view.camera.height;
  photographs = std::min(photographs, std::size_t(options.memory) << 20);
  return {0, photographs + views.size() * most_cells * sizeof(float), 540}; // measured: docs/texture.md
}
} // namespace

TextureResult reconstructTexture(TriangleMesh mesh, const std::vector<TextureView>& views,
                                 const TextureOptions& options, const Progress& progress, const AtlasSink& take)
{
  validate(mesh, views, options);
  if (const Index most = tileFaces(mesh.faceCount(), options.tile_faces, memoryNeed(views, options));
      most < mesh.faceCount())
    return textureInTiles(std::move(mesh), views, options, progress, {most, take});
  TexturedMesh model;
  model.mesh = std::move(mesh);
  return reconstruct(model, views, options, progress);
}

TextureResult reconstructTexture(const TexturedMesh& model, const std::vector<TextureView>& views,
                                 const TextureOptions& options, const Progress& progress)
{
  validate(model.mesh, views, options);
  validateLayout(model);
  require(options.texel == 0, "texture: texels of a given layout have their size");
  require(options.tile_faces == 0, "texture: a given layout is not cut into tiles");
  if (tileFaces(model.mesh.faceCount(), 0, memoryNeed(views, options)) < model.mesh.faceCount())
    throw std::runtime_error(concat("texture: memory does not hold ", model.mesh.faceCount(),
                                    " faces at once, and a given layout is not cut into tiles"));
  return reconstruct(model, views, options, progress);
}
} // namespace fresco
