// SPDX-License-Identifier: BSD-3-Clause
#include "charts/texture_atlas.h"
#include "filling/color_diffusion.h"
#include "painting/color_growth.h"
#include "painting/painted_part.h"
#include "photographs/input_checks.h"
#include "points/point_painting.h"
#include "points/point_values.h"
#include "tiles/tile_atlases.h"
#include "tiles/tile_traces.h"
#include "views/visible_surface.h"
#include <cmath>
#include <fresco/core/require.h>
#include <fresco/core/statistics.h>
namespace fresco {
using namespace texture;
namespace {
void validate(const TriangleMesh& mesh, const PointSet& points, const PointTextureOptions& options)
{
  texture::validate(mesh, {}, layoutOptions(options));
  validatePointSet(points);
  require(options.width >= 0.3 && options.width <= 10, "texture: width ", options.width, " is not in 0.3..10");
  require(options.rounds >= 0 && options.rounds <= 20, "texture: rounds ", options.rounds, " is not in 0..20");
}

/// Patches of a few samples each, so that few samples count for a texel of one.
double patchSide(const TriangleMesh& mesh, const SurfaceSamples& samples, Index tiles)
{
  constexpr double patch_samples = 8; // along a side
  const double spacing = median(std::vector<float>(samples.spacing.begin(), samples.spacing.end()));
  return std::max(std::sqrt(surfaceArea(mesh) / (0.43 * most_patches * tiles)), patch_samples * spacing);
}

/// What all tiles are painted with.
struct Paint {
  const SurfaceSamples& samples;
  const SurfaceGaussian& gaussian;
  const Points& values; ///< sharpened
  double patch_side;
  const PointTextureOptions& options;
};

/// Patches with the number of samples per mesh unit on each.
struct SampledPatches {
  PatchMesh patches;
  Eigen::VectorXf density;
  Eigen::VectorXi view; ///< 0 = seen, -1 = unseen

  SampledPatches(const TriangleMesh& mesh, const Paint& paint)
      : patches(cutFaces(mesh, paint.patch_side, paint.options.threads)),
        density(patchDensities(patches, paint.samples, paint.gaussian, paint.options.threads)),
        view((density.array() > 0).cast<int>() - 1)
  {}
};

/// @return 3xP, colours of the own patches, if they are a tile's
Points paintModel(const Paint& paint, const PaintedPart& part, SampledPatches& sampled, TextureResult& result)
{
  const PointTextureOptions& options = paint.options;
  auto& [patches, density, view] = sampled;
  const std::vector<Chart> charts = makeAtlas(patches, density, layoutOptions(options), result, part.faces);
  const std::vector<TexelSlot> slots = texelSlots(charts, patches.size());
  const PaintScene scene{patches, charts, view, slots, options.threads};
  std::vector<Image>& atlases = result.model.atlases;
  paintSamples(scene, {paint.gaussian, paint.values}, view, part.patches, result);
  const std::vector<char> clipped(patches.size());
  const Points around = diffuseColors(patches, knownColors(scene, part, atlases), clipped, options.threads);
  paintUnseen(scene, around, atlases, result.masks);
  fillGaps(charts, options.threads, atlases);
  return part.fill_colors ? takeOwn(scene, part, result) : Points();
}

void paintWhole(const Paint& paint, TextureResult& result)
{
  const Faces faces = result.model.mesh.faces;
  weld(result);
  SampledPatches sampled(result.model.mesh, paint);
  paintModel(paint, {faces.cols(), sampled.patches.size()}, sampled, result);
  result.model.mesh.faces = faces;
}

/// What no point shows continues what the tiles before have around it.
void paintTiles(const Paint& paint, const MeshTiles& tiles, const AtlasSink& take, const Progress& progress,
                TextureResult& result)
{
  const TriangleMesh& mesh = result.model.mesh;
  const float halo = halo_patches * meanEdge(mesh, 0.75 * paint.patch_side);
  TileAtlases atlases(take, result);
  TileTraces traces;
  for (Index t = 0; t < tiles.count(); ++t) {
    const TileMesh tile = tileMesh(mesh, tiles, t, -1);
    const SampledPatches own(tile.mesh, paint);
    traces.add(tile, own.patches, own.view);
  }
  for (Index t = 0; t < tiles.count(); ++t) {
    report(progress, concat("tile ", t + 1, " of ", tiles.count(), ": painting"), 1.0 * t / tiles.count());
    const TileMesh tile = tileMesh(mesh, tiles, t, halo);
    SampledPatches sampled(tile.mesh, paint);
    const Points known = traces.colors(tile, sampled.patches);
    TextureResult painted;
    painted.model.mesh = tile.mesh;
    PaintedPart part{tile.own, TileTraces::ownPatches(tile, sampled.patches)};
    part.fill_colors = &known;
    traces.setColors(t, paintModel(paint, part, sampled, painted));
    atlases.add(tiles, t, std::move(painted));
  }
  atlases.finish();
}

/// All but the model.
void describe(const TextureResult& painted, PointTextureResult& result)
{
  result.coverage = painted.coverage;
  result.used = painted.used;
  result.texel = painted.texel;
  result.charts = painted.charts;
  result.warnings.insert(result.warnings.end(), painted.warnings.begin(), painted.warnings.end());
}
} // namespace

PointTextureResult reconstructPointTexture(TriangleMesh mesh, const PointSet& points,
                                           const PointTextureOptions& options, const Progress& progress,
                                           const AtlasSink& take)
{
  validate(mesh, points, options);
  PointTextureResult result;
  result.look = lookOf(points, &result.warnings);
  if (result.look == PointLook::none) {
    result.model.texcoord_faces = Faces::Constant(3, mesh.faceCount(), -1);
    result.model.face_atlas = Eigen::VectorXi::Constant(mesh.faceCount(), -1);
    result.model.mesh = std::move(mesh);
    return result;
  }
  constexpr std::size_t bytes_per_face = 290, bytes_per_point = 100; // measured: docs/texture.md
  const MeshTiles tiles = cutIntoTiles(
      mesh, tileFaces(mesh.faceCount(), options.tile_faces, {points.size() * bytes_per_point, 0, bytes_per_face}));
  report(progress, "points on the surface", 0.0);
  const SurfaceSamples samples = sampleSurface(mesh, tiles, points, options.threads);
  if (samples.size() == 0)
    throw std::runtime_error("texture: no point lies on the front of the mesh");
  report(progress, "exposure", 0.3);
  const Points values = sampleValues(points, samples, options, result);
  report(progress, "painting", 0.4);
  const SurfaceGaussian gaussian(samples, options.width);
  const Points sharp = sharpened(samples, gaussian, values, options);
  const Paint paint{samples, gaussian, sharp, patchSide(mesh, samples, tiles.count()), options};
  TextureResult painted;
  painted.model.mesh = std::move(mesh);
  if (tiles.count() > 1)
    paintTiles(paint, tiles, take, subProgress(progress, 0.4, 1), painted);
  else
    paintWhole(paint, painted);
  describe(painted, result);
  result.model = std::move(painted.model);
  result.masks = std::move(painted.masks);
  report(progress, "done", 1.0);
  return result;
}
} // namespace fresco
