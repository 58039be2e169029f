// SPDX-License-Identifier: BSD-3-Clause
#include "charts/texture_atlas.h"
#include "filling/color_diffusion.h"
#include "filling/exemplar_inpainting.h"
#include "input_checks.h"
#include "painting/color_growth.h"
#include "points/point_painting.h"
#include "points/point_values.h"
#include <cmath>
#include <fresco/core/require.h>
#include <fresco/core/statistics.h>
namespace fresco {
using namespace texture;
namespace {
/// Those that say how the atlas is laid out.
TextureOptions layoutOptions(const PointTextureOptions& options)
{
  TextureOptions out;
  out.texel = options.texel;
  out.atlas = options.atlas;
  out.border = options.border;
  out.threads = options.threads;
  return out;
}

void validate(const TriangleMesh& mesh, const PointSet& points, const PointTextureOptions& options)
{
  texture::validate(mesh, {}, layoutOptions(options));
  validatePointSet(points);
  require(options.width >= 0.3 && options.width <= 10, "texture: width ", options.width, " is not in 0.3..10");
  require(options.rounds >= 0 && options.rounds <= 20, "texture: rounds ", options.rounds, " is not in 0..20");
  constexpr std::size_t bytes_per_face = 290, bytes_per_point = 100; // measured: docs/texture.md
  requireMemory(mesh.faceCount(), mesh.faceCount() * bytes_per_face + points.size() * bytes_per_point);
}

/// Patches of a few samples each, so that few samples count for a texel of one.
double patchSide(const TriangleMesh& mesh, const SurfaceSamples& samples)
{
  constexpr double patch_samples = 8;  // along a side
  constexpr double most_patches = 1e6; // bounds the memory
  const double spacing = median(std::vector<float>(samples.spacing.begin(), samples.spacing.end()));
  return std::max(std::sqrt(surfaceArea(mesh) / (0.43 * most_patches)), patch_samples * spacing);
}

void paintModel(const SurfaceSamples& samples, const Points& values, const PointTextureOptions& options,
                TextureResult& result)
{
  const SurfaceGaussian gaussian(samples, options.width);
  const PatchMesh patches = cutFaces(result.model.mesh, patchSide(result.model.mesh, samples), options.threads);
  const Eigen::VectorXf density = patchDensities(patches, samples, gaussian, options.threads);
  Eigen::VectorXi view = (density.array() > 0).cast<int>() - 1;
  const std::vector<Chart> charts = makeAtlas(patches, density, layoutOptions(options), result);
  const std::vector<TexelSlot> slots = texelSlots(charts, patches.size());
  const PaintScene scene{patches, charts, view, slots, options.threads};
  std::vector<Image>& atlases = result.model.atlases;
  paintSamples(scene, {gaussian, sharpened(samples, gaussian, values, options)}, view, result);
  paintUnseen(scene, diffuseColors(patches, patchColors(scene, atlases), options.threads), atlases, result.masks);
  if (options.examples)
    inpaintByExample(scene, result.masks, atlases);
  fillGaps(charts, options.threads, atlases);
}
} // namespace

PointTextureResult reconstructPointTexture(const TriangleMesh& mesh, const PointSet& points,
                                           const PointTextureOptions& options, const Progress& progress)
{
  validate(mesh, points, options);
  PointTextureResult result;
  result.look = lookOf(points, &result.warnings);
  result.model.mesh = mesh;
  if (result.look == PointLook::none) {
    result.model.texcoord_faces = Faces::Constant(3, mesh.faceCount(), -1);
    result.model.face_atlas = Eigen::VectorXi::Constant(mesh.faceCount(), -1);
    return result;
  }
  report(progress, "points on the surface", 0.0);
  const SurfaceSamples samples = sampleSurface(mesh, points, options.threads);
  if (samples.size() == 0)
    throw std::runtime_error("texture: no point lies on the front of the mesh");
  report(progress, "exposure", 0.3);
  const Points values = sampleValues(points, samples, options, result);
  report(progress, "painting", 0.4);
  TextureResult painted;
  painted.model.mesh = mesh;
  weld(painted);
  paintModel(samples, values, options, painted);
  result.model = std::move(painted.model);
  result.model.mesh.faces = mesh.faces;
  result.masks = std::move(painted.masks);
  result.coverage = painted.coverage;
  result.used = painted.used;
  result.texel = painted.texel;
  result.charts = painted.charts;
  result.warnings.insert(result.warnings.end(), painted.warnings.begin(), painted.warnings.end());
  report(progress, "done", 1.0);
  return result;
}
} // namespace fresco
