// SPDX-License-Identifier: BSD-3-Clause
#include "cameras/camera_refinement.h"
#include "charts/given_layout.h"
#include "charts/texture_atlas.h"
#include "filling/color_diffusion.h"
#include "filling/exemplar_inpainting.h"
#include "input_checks.h"
#include "painting/atlas_paint.h"
#include "painting/back_projection.h"
#include "painting/color_growth.h"
#include "painting/outline_texels.h"
#include "photometry/exposure.h"
#include "views/face_orientation.h"
#include "views/photo_consistency.h"
#include "views/view_selection.h"
#include "views/visible_surface.h"
#include <chrono>
#include <fresco/core/require.h>
#include <fresco/texture/core/texture_reconstruction.h>
#include <memory>
namespace fresco {
using namespace texture;
namespace {
/// Reports the steps and measures their time.
class Steps {
public:
  Steps(const Progress& progress, TextureResult& result) : progress_(progress), result_(result) {}

  /// Ends the step before.
  /// @param share of the whole work that is done, 0..1
  void begin(const std::string& step, double share)
  {
    const auto now = std::chrono::steady_clock::now();
    if (!step_.empty())
      result_.seconds.emplace_back(step_, std::chrono::duration<double>(now - begin_).count());
    report(progress_, step, share);
    step_ = step;
    begin_ = now;
  }

private:
  const Progress& progress_;
  TextureResult& result_;
  std::string step_;
  std::chrono::steady_clock::time_point begin_;
};

/// @return one per part, in the mesh's coordinates
std::vector<Projector> projectorsOf(const TriangleMesh& mesh, const std::vector<ViewPart>& parts,
                                    const std::vector<PlacedCamera>& cameras)
{
  std::vector<Projector> out;
  for (const ViewPart& part : parts) {
    const auto& [camera, T_camera_world] = cameras[part.view];
    out.emplace_back(part.ofPanorama() ? part.camera : camera, part.R_part_view * T_camera_world, mesh.origin);
  }
  return out;
}

/// Numbers of what was given in place of numbers of parts.
Eigen::VectorXi ownersOf(const Eigen::VectorXi& view, const std::vector<int>& owner)
{
  return view.unaryExpr([&](int v) { return v < 0 ? -1 : owner[v]; });
}

/// Values of what was given as values of parts; none stay none.
template <typename T>
std::vector<T> ofParts(const std::vector<T>& values, const std::vector<int>& owner)
{
  std::vector<T> out;
  for (std::size_t part = 0; part < owner.size() && !values.empty(); ++part)
    out.push_back(values[owner[part]]);
  return out;
}

/// What all steps read and write.
struct Job {
  const TextureOptions& options;
  const ViewList& views;
  Steps& steps;
  TextureResult& result;
};

/// Which photograph each patch is painted from.
struct ViewChoice {
  VisibleSurface surface;
  Photometry photometry;
  PhotoConsistency consistency;
  Eigen::VectorXi view; ///< P, -1 = unseen
};

/// Patches that are painted from what does not belong to the surface become unseen.
void hideForeign(const Candidates& candidates, const std::vector<char>& foreign, Eigen::VectorXi& view)
{
  for (Index i = 0; i < view.size(); ++i)
    if (view[i] >= 0 && foreign[candidates.find(i, view[i]) - candidates.list.data()])
      view[i] = -1;
}

ViewChoice chooseViews(const Job& job, const RayScene& rays, const Progress& progress)
{
  const auto& [options, views, steps, result] = job;
  ViewChoice out;
  steps.begin("visibility", 0.25);
  out.surface = findVisibleSurface(result.model.mesh, {rays, views, options}, subProgress(progress, 0.25, 0.4));
  const auto& [patches, candidates, outlines] = out.surface;

  steps.begin("exposure", 0.4);
  if (options.exposure)
    out.photometry = solvePhotometry(candidates, views.lenses, views.owner);
  else
    out.photometry.gains.setOnes(3, views.projectors.size());
  describePhotometry(out.photometry, views.owner, result.cameras.size(), result);

  steps.begin("view selection", 0.4);
  if (options.consistency)
    out.consistency = photoConsistency(patches, candidates, out.photometry, {rays, views, options});
  else
    out.consistency = {std::vector<float>(candidates.list.size(), 0.f), std::vector<char>(candidates.list.size(), 0)};
  const double seam_cost = options.smoothness * diagonalOf(result.model.mesh);
  out.view = selectViews(patches, {candidates, out.consistency.penalties}, seam_cost, options.threads);
  hideForeign(candidates, out.consistency.foreign, out.view);
  return out;
}

/// Paints what photographs show; patches that none shows clean become unseen.
/// @param view of the scene's patches
void paintPhotographs(const PaintScene& scene, const PaintSources& sources, Eigen::VectorXi& view, const Job& job)
{
  TextureResult& result = job.result;
  OutlineTexels beside;
  if (!sources.masks.empty())
    beside = findOutlineTexels(scene, sources);
  for (const int patch : beside.hidden)
    view[patch] = -1;
  describeViews(scene.patches, ownersOf(view, job.views.owner), result);
  paintSeen(scene, sources, result.model.atlases);
  paintTexels(scene, sources, beside.by_view, result.model.atlases);
  fillUnknown(scene, beside.unknown, result.model.atlases, result.masks);
}

void paintModel(const Job& job, ViewChoice& choice)
{
  const auto& [options, views, steps, result] = job;
  const auto& [patches, candidates, outlines] = choice.surface;
  std::vector<Image>& atlases = result.model.atlases;
  steps.begin("charts", 0.6);
  const Eigen::VectorXf resolution = patchResolutions(patches, views.projectors, choice.view);
  const std::vector<Chart> charts = makeAtlas(patches, resolution, options, result);

  steps.begin("seams", 0.7);
  const double blend_width = options.blend_width * pixelSize(resolution);
  const Blend blend = blendViews({patches, candidates, choice.view, choice.photometry, choice.consistency.penalties},
                                 {blend_width, options.level, options.threads});

  steps.begin("painting", 0.8);
  const std::vector<TexelSlot> slots = texelSlots(charts, patches.size());
  const PaintScene scene{patches, charts, choice.view, slots, options.threads};
  const PaintSources sources{
      views.projectors, views.photos, choice.photometry, blend, candidates, choice.consistency.penalties, outlines};
  paintPhotographs(scene, sources, choice.view, job);

  steps.begin("back-projection", 0.85);
  if (options.exposure)
    backProject(scene, sources, {options.rounds, ofParts(registrationErrors(result), views.owner)}, atlases);

  steps.begin("inpainting", 0.9);
  paintUnseen(scene, diffuseColors(patches, patchColors(scene, atlases), options.threads), atlases, result.masks);

  steps.begin("examples", 0.93);
  if (options.examples)
    inpaintByExample(scene, result.masks, atlases);

  steps.begin("gaps", 0.98);
  fillGaps(charts, options.threads, atlases);
}

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
  warnOfMisfits(views, result);
  ViewList list{projectors, photos, {}, {}, poseUncertainty(result), lensNumbers(parts), {}};
  for (const ViewPart& part : parts) {
    list.used.push_back(part.given->paint);
    list.owner.push_back(part.view);
  }
  list.misfits = ofParts(misfits(result), list.owner);
  const Job job{options, list, steps, result};
  ViewChoice choice = chooseViews(job, *rays, progress);
  rays.reset(); // painting needs the memory
  paintModel(job, choice);
  warnOfLittleSeen(result.coverage, views, result);
  result.model.mesh.faces = mesh.faces;
  steps.begin("done", 1.0);
  return result;
}
} // namespace

TextureResult reconstructTexture(const TriangleMesh& mesh, const std::vector<TextureView>& views,
                                 const TextureOptions& options, const Progress& progress)
{
  validate(mesh, views, options);
  TexturedMesh model;
  model.mesh = mesh;
  return reconstruct(model, views, options, progress);
}

TextureResult reconstructTexture(const TexturedMesh& model, const std::vector<TextureView>& views,
                                 const TextureOptions& options, const Progress& progress)
{
  validate(model.mesh, views, options);
  validateLayout(model);
  require(options.texel == 0, "texture: texels of a given layout have their size");
  return reconstruct(model, views, options, progress);
}
} // namespace fresco
