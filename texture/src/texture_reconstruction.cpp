// SPDX-License-Identifier: BSD-3-Clause
#include "cameras/camera_refinement.h"
#include "charts/texture_atlas.h"
#include "filling/color_diffusion.h"
#include "filling/exemplar_inpainting.h"
#include "painting/atlas_gaps.h"
#include "painting/atlas_paint.h"
#include "painting/back_projection.h"
#include "painting/outline_texels.h"
#include "views/exif.h"
#include "views/exposure.h"
#include "views/hidden_parts.h"
#include "views/photo_consistency.h"
#include "views/resolution.h"
#include "views/view_selection.h"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/texture/core/texture_reconstruction.h>
#include <memory>
namespace fresco {
using namespace texture;
namespace {
constexpr float patch_pixels = 16; // longest side of a patch in a typical view

void validateView(const TextureView& view, std::size_t index)
{
  const std::string name = view.path.empty() ? concat("view ", index) : view.path;
  const CameraModel& c = view.camera;
  require(c.width >= 3 && c.height >= 3 && c.width <= 65535 && c.height <= 65535, "texture: ", name, ": camera of ",
          c.width, "x", c.height, " pixels");
  require(c.fx > 0 && c.fy > 0 && std::isfinite(c.fx + c.fy + c.cx + c.cy + c.k1 + c.k2 + c.p1 + c.p2),
          "texture: ", name, ": intrinsics are not finite or a focal length is not positive");
  const Eigen::Matrix3d R = view.T_camera_world.linear();
  require(view.T_camera_world.matrix().allFinite() && (R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-3 &&
              R.determinant() > 0,
          "texture: ", name, ": the pose is not finite or no rigid motion");
  require(!view.image.empty() || !view.path.empty(), "texture: ", name, ": neither an image nor a path");
}

void validate(const TriangleMesh& mesh, const std::vector<TextureView>& views, const TextureOptions& options)
{
  validateMesh(mesh);
  require(mesh.faceCount() > 0 && surfaceArea(mesh) > 0, "texture: the mesh has no face of positive area");
  require(mesh.vertexCount() < (1 << 29) && mesh.faceCount() < (1 << 29), "texture: the mesh is too large");
  require(options.texel >= 0 && std::isfinite(options.texel), "texture: texel ", options.texel,
          " is negative or not finite");
  require(options.atlas == 0 || (options.atlas >= 128 && options.atlas <= 16384), "texture: atlas ", options.atlas,
          " is neither 0 nor in 128..16384");
  require(options.border >= 1 && options.border <= 16, "texture: border ", options.border, " is not in 1..16");
  require(options.smoothness >= 0 && std::isfinite(options.smoothness), "texture: smoothness ", options.smoothness,
          " is negative or not finite");
  require(options.margin >= 0 && options.margin <= 100, "texture: margin ", options.margin, " is not in 0..100");
  require(options.depth_tolerance >= 0 && options.depth_tolerance <= 0.5, "texture: depth tolerance ",
          options.depth_tolerance, " is not in 0..0.5");
  require(options.strip >= 0 && options.strip <= 100, "texture: strip ", options.strip, " is not in 0..100");
  require(options.rounds >= 0 && options.rounds <= 100, "texture: rounds ", options.rounds, " is not in 0..100");
  require(options.memory >= 1, "texture: memory ", options.memory, " MB is below 1");
  for (std::size_t v = 0; v < views.size(); ++v)
    validateView(views[v], v);
}

double diagonalOf(const TriangleMesh& mesh)
{
  Eigen::Vector3f low = mesh.vertices.col(mesh.faces(0, 0)), high = low;
  for (Index i = 0; i < mesh.faces.size(); ++i) {
    low = low.cwiseMin(mesh.vertices.col(mesh.faces.data()[i]));
    high = high.cwiseMax(mesh.vertices.col(mesh.faces.data()[i]));
  }
  return (high - low).norm();
}

/// Side that a typical view sees patch_pixels long; so large that there are at most a million patches by cutting.
float longestEdge(const TriangleMesh& mesh, const std::vector<Projector>& views)
{
  constexpr Index samples = 2000;
  constexpr double most_patches = 1e6;
  const Index stride = std::max<Index>(1, mesh.faceCount() / samples);
  std::vector<float> sizes; // of a pixel
  for (const Projector& view : views)
    for (Index f = 0; f < mesh.faceCount(); f += stride) {
      const Eigen::Vector3f p = view(mesh.vertices.col(mesh.faces(0, f)));
      if (p.z() > 0 && p.x() >= 0 && p.y() >= 0 && p.x() <= view.camera().width && p.y() <= view.camera().height)
        sizes.push_back(p.z() / view.focal());
    }
  const float least = std::sqrt(surfaceArea(mesh) / (0.43 * most_patches));
  if (sizes.empty())
    return static_cast<float>(std::max<double>(least, 0.05 * diagonalOf(mesh)));
  std::nth_element(sizes.begin(), sizes.begin() + sizes.size() / 2, sizes.end());
  return std::max(least, patch_pixels * sizes[sizes.size() / 2]);
}

PatchMesh makePatches(const TriangleMesh& mesh, const RayScene& rays, const ViewList& views,
                      const TextureOptions& options)
{
  PatchMesh patches = cutFaces(mesh, longestEdge(mesh, views.projectors), options.threads);
  // vague outlines are not worth following closely
  return views.doubt < 1 ? cutHiddenParts(std::move(patches), rays, views, options) : patches;
}

std::vector<Projector> projectorsOf(const TriangleMesh& mesh, const std::vector<PlacedCamera>& cameras)
{
  std::vector<Projector> out;
  for (const PlacedCamera& c : cameras)
    out.emplace_back(c.camera, c.T_camera_world, mesh.origin);
  return out;
}

std::vector<char> paintable(const std::vector<TextureView>& views)
{
  std::vector<char> out;
  for (const TextureView& view : views)
    out.push_back(view.paint);
  return out;
}

void placeCameras(const RayScene& scene, const std::vector<TextureView>& views, PhotoStore& photos,
                  const TextureOptions& options, const Progress& progress, TextureResult& result)
{
  for (const TextureView& view : views)
    result.cameras.push_back({view.camera, view.T_camera_world});
  constexpr std::size_t most_views = 400; // the normal equations are solved densely
  if (options.refine && views.size() > most_views)
    result.warnings.push_back(concat("cameras are taken as given: ", views.size(), " views are more than the ",
                                     most_views, " that are refined"));
  if (!options.refine || views.size() < 2 || views.size() > most_views)
    return;
  const RefinedCameras refined = refineCameras(result.model.mesh, scene, views, photos, options.threads, progress);
  result.refined = refined.changed;
  result.disagreement_before = refined.before;
  result.disagreement_after = refined.changed ? refined.after : refined.before;
  for (std::size_t v = 0; v < views.size() && refined.changed; ++v)
    result.cameras[v] = {refined.cameras[v], refined.T_camera_world[v]};
}

/// How far outlines are to be distrusted, 0.2..1: where the photographs agree on the mesh to a fraction of a pixel,
/// mesh and cameras are nearly exact, and what is seen close to an outline is right. 1 where that is not known.
double doubtOf(const TextureResult& result)
{
  constexpr double exact = 0.3, vague = 0.7; // pixels: what matching itself errs by, and a disagreement that shows
  constexpr double least = 0.2;
  const double doubt = (result.disagreement_after - exact) / (vague - exact);
  return result.disagreement_before > 0 ? std::clamp(doubt, least, 1.0) : 1.0;
}

/// Whether texels may be made of several photographs: they are known to agree, in place and in colour.
bool agrees(const TextureResult& result, const TextureOptions& options)
{
  constexpr double most = 0.5; // pixels
  return options.exposure && result.disagreement_before > 0 && result.disagreement_after <= most;
}

/// For each face the view that most of its area is taken from.
Eigen::VectorXi viewsOfFaces(const PatchMesh& patches, const Eigen::VectorXi& view, Index faces)
{
  Eigen::VectorXi out = Eigen::VectorXi::Constant(faces, -1);
  std::vector<std::pair<int, float>> areas; // of the views of one face
  for (Index i = 0; i < patches.size(); ++i) {
    if (i == 0 || patches.parent[i] != patches.parent[i - 1])
      areas.clear();
    const auto at = std::find_if(areas.begin(), areas.end(), [&](const auto& a) { return a.first == view[i]; });
    if (at == areas.end())
      areas.emplace_back(view[i], patches.areas[i]);
    else
      at->second += patches.areas[i];
    out[patches.parent[i]] = std::max_element(areas.begin(), areas.end(), [](const auto& a, const auto& b) {
                               return a.second < b.second;
                             })->first;
  }
  return out;
}

class Stopwatch {
public:
  explicit Stopwatch(TextureResult& result) : result_(result) {}
  void lap(const std::string& phase)
  {
    const auto now = std::chrono::steady_clock::now();
    result_.seconds.emplace_back(phase, std::chrono::duration<double>(now - last_).count());
    last_ = now;
  }

private:
  TextureResult& result_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

void warnOfRotations(const std::vector<TextureView>& views, TextureResult& result)
{
  std::string first;
  Index count = 0;
  for (const TextureView& view : views)
    if (view.image.empty() && exifOrientation(view.path) != 1 && count++ == 0)
      first = view.path;
  if (count > 0)
    result.warnings.push_back(
        concat(first, count > 1 ? concat(" and ", count - 1, " more carry") : " carries",
               " an EXIF rotation, which is ignored: cameras belong to pixels as they are stored"));
}

/// Reads every photograph once, so that one that is missing or of another size is found before the long work.
void checkPhotos(PhotoStore& photos, const std::vector<TextureView>& views, int threads, TextureResult& result)
{
  parallelFor(
      views.size(), threads, [&](Index v) { photos.get(v); }, 1);
  warnOfRotations(views, result);
}

void fillFigures(const PatchMesh& patches, const Eigen::VectorXi& view, TextureResult& result)
{
  double seen = 0;
  std::vector<char> used(view.maxCoeff() + 1, 0);
  for (Index i = 0; i < patches.size(); ++i)
    if (view[i] >= 0) {
      seen += patches.areas[i];
      used[view[i]] = 1;
    }
  result.coverage = std::min(1.0, seen / patches.areas.cast<double>().sum());
  result.views_used = std::count(used.begin(), used.end(), 1);
  result.seam_length = seamLength(patches, view);
  result.face_view = viewsOfFaces(patches, view, result.model.mesh.faceCount());
}

/// @param view of scene; patches that no photograph shows clean become unseen
void paintPhotographs(const PaintScene& scene, const PaintSources& sources, const OutlineSources& outlines,
                      Eigen::VectorXi& view, TextureResult& result)
{
  OutlineTexels beside;
  if (!outlines.masks.empty())
    beside = findOutlineTexels(scene, outlines);
  for (const int patch : beside.hidden)
    view[patch] = -1;
  fillFigures(scene.patches, view, result);
  paintSeen(scene, sources, result.model.atlases);
  paintTexels(scene, sources, beside.by_view, result.model.atlases);
  fillUnknown(scene, beside.unknown, result.model.atlases, result.masks);
}
} // namespace

TextureResult reconstructTexture(const TriangleMesh& mesh, const std::vector<TextureView>& views,
                                 const TextureOptions& options, const Progress& progress)
{
  validate(mesh, views, options);
  TextureResult result;
  result.model.mesh = mesh;
  Stopwatch watch(result);
  report(progress, "photographs", 0.0);
  PhotoStore photos(views, static_cast<std::size_t>(options.memory) << 20);
  checkPhotos(photos, views, options.threads, result);
  watch.lap("photographs");
  auto rays = std::make_unique<RayScene>(mesh);
  placeCameras(*rays, views, photos, options, subProgress(progress, 0.05, 0.25), result);
  watch.lap("camera refinement");
  const std::vector<Projector> projectors = projectorsOf(mesh, result.cameras);
  const ViewList list{projectors, photos, paintable(views), doubtOf(result)};
  const PatchMesh patches = makePatches(mesh, *rays, list, options);
  const Candidates candidates = findCandidates(patches, *rays, list, options, subProgress(progress, 0.25, 0.4));
  const std::vector<OutlineMask> outlines =
      list.doubt < 1 ? outlineMasks(patches, *rays, list, options) : std::vector<OutlineMask>();
  rays.reset();
  watch.lap("visibility");
  const Index count = views.size();
  result.gains = options.exposure ? solveGains(candidates, count) : Points(Points::Ones(3, count));
  watch.lap("exposure");
  report(progress, "view selection", 0.4);
  const std::vector<float> odd = options.consistency ? oddityCosts(patches, candidates, result.gains, options.threads)
                                                     : std::vector<float>(candidates.list.size(), 0.f);
  Eigen::VectorXi view =
      selectViews(patches, {candidates, odd}, options.smoothness * diagonalOf(mesh), options.threads);
  watch.lap("view selection");
  report(progress, "charts", 0.6);
  const Eigen::VectorXf resolution = patchResolutions(patches, projectors, view);
  const std::vector<Chart> charts = makeAtlas(patches, resolution, options, result);
  watch.lap("charts");
  report(progress, "seams", 0.7);
  const Blend blend = blendViews(patches, candidates, view, result.gains,
                                 {options.strip * pixelSize(resolution), options.level, options.threads});
  watch.lap("seams");
  report(progress, "painting", 0.8);
  const Eigen::VectorXi face_chart = chartsOfFaces(charts, mesh.faceCount());
  const std::vector<int> slots = texelSlots(charts, patches.size());
  const PaintScene scene{patches, charts, face_chart, view, slots, options.threads};
  const PaintSources sources{projectors, result.gains, blend, photos};
  paintPhotographs(scene, sources, {projectors, candidates, odd, blend, outlines}, view, result);
  watch.lap("painting");
  if (agrees(result, options))
    backProject(scene, {projectors, result.gains, photos, candidates, odd}, options.rounds, result.model.atlases);
  watch.lap("back-projection");
  report(progress, "inpainting", 0.9);
  const Points colors = diffuseColors(patches, patchColors(scene, result.model.atlases), options.threads);
  paintUnseen(scene, colors, result.model.atlases, result.masks);
  watch.lap("inpainting");
  report(progress, "examples", 0.93);
  if (options.examples)
    inpaintByExample(scene, result.masks, result.model.atlases);
  watch.lap("examples");
  fillGaps(charts, options.threads, result.model.atlases);
  watch.lap("gaps");
  report(progress, "done", 1.0);
  return result;
}
} // namespace fresco
