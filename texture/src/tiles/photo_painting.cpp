// SPDX-License-Identifier: BSD-3-Clause
#include "tiles/photo_painting.h"
#include "cameras/camera_refinement.h"
#include "charts/texture_atlas.h"
#include "filling/clipped_texels.h"
#include "filling/color_diffusion.h"
#include "painting/atlas_paint.h"
#include "painting/back_projection.h"
#include "painting/color_growth.h"
#include "painting/outline_texels.h"
#include "photometry/exposure.h"
#include "views/view_selection.h"
#include <algorithm>
#include <fresco/core/require.h>
namespace fresco::texture {
namespace {
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

/// Patches that are painted from what does not belong to the surface become unseen.
void hideForeign(const Candidates& candidates, const std::vector<char>& foreign, Eigen::VectorXi& view)
{
  for (Index i = 0; i < view.size(); ++i)
    if (view[i] >= 0 && foreign[candidates.find(i, view[i]) - candidates.list.data()])
      view[i] = -1;
}

/// Paints what photographs show; patches that none shows clean become unseen.
/// @param view of the scene's patches
/// @param own  patches that count
void paintPhotographs(const PaintScene& scene, const PaintSources& sources, Eigen::VectorXi& view, Index own,
                      const Job& job)
{
  TextureResult& result = job.result;
  OutlineTexels beside;
  if (!sources.masks.empty())
    beside = findOutlineTexels(scene, sources);
  for (const int patch : beside.hidden)
    view[patch] = -1;
  describeViews(scene.patches, ownersOf(view.head(own), job.views.owner), result);
  paintSeen(scene, sources, result.model.atlases);
  paintTexels(scene, sources, beside.by_view, result.model.atlases);
  fillUnknown(scene, beside.unknown, result.model.atlases, result.masks);
}
} // namespace

void Steps::begin(const std::string& step, double share)
{
  const auto now = std::chrono::steady_clock::now();
  if (!step_.empty()) {
    auto& all = result_.seconds;
    auto at = std::find_if(all.begin(), all.end(), [&](const auto& s) { return s.first == step_; });
    if (at == all.end())
      at = all.insert(at, {step_, 0.0});
    at->second += std::chrono::duration<double>(now - begin_).count();
  }
  constexpr double before_parts = 0.25;
  report(progress_, part_ + step,
         share <= before_parts ? share : from_ + (to_ - from_) * (share - before_parts) / (1 - before_parts));
  step_ = step;
  begin_ = now;
}

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

ViewList viewList(const std::vector<Projector>& projectors, PhotoStore& photos, const std::vector<ViewPart>& parts,
                  const TextureResult& result)
{
  ViewList out{projectors, photos, {}, {}, poseUncertainty(result), lensNumbers(parts), {}};
  for (const ViewPart& part : parts) {
    out.used.push_back(part.given->paint);
    out.owner.push_back(part.view);
  }
  out.misfits = ofParts(misfits(result), out.owner);
  return out;
}

Photometry findPhotometry(const Candidates& candidates, const Job& job)
{
  const auto& [options, views, steps, result] = job;
  Photometry out;
  if (options.exposure)
    out = solvePhotometry(candidates, views.lenses, views.owner);
  else
    out.gains.setOnes(3, views.projectors.size());
  describePhotometry(out, views.owner, result.cameras.size(), result);
  return out;
}

void compareViews(const VisibilityInput& input, ViewChoice& choice)
{
  const std::size_t candidates = choice.surface.candidates.list.size();
  if (input.options.consistency)
    choice.consistency = photoConsistency(choice.surface.patches, choice.surface.candidates, choice.photometry, input);
  else
    choice.consistency = {std::vector<float>(candidates, 0.f), std::vector<char>(candidates, 0)};
}

void chooseViews(const TextureOptions& options, double seam_cost, ViewChoice& choice)
{
  const auto& [patches, candidates, outlines] = choice.surface;
  choice.view = selectViews(patches, {candidates, choice.consistency.penalties}, seam_cost, options.threads);
  hideForeign(candidates, choice.consistency.foreign, choice.view);
}

int blendRounds(const Job& job, const ViewChoice& choice)
{
  const Eigen::VectorXf resolution = patchResolutions(choice.surface.patches, job.views.projectors, choice.view);
  return blendRounds(meanEdge(choice.surface.patches), job.options.blend_width * pixelSize(resolution));
}

Points paintModel(const Job& job, ViewChoice& choice, const PaintedPart& part)
{
  const auto& [options, views, steps, result] = job;
  const auto& [patches, candidates, own_outlines] = choice.surface;
  const std::vector<OutlineMask>& outlines = part.outlines ? *part.outlines : own_outlines;
  std::vector<Image>& atlases = result.model.atlases;
  steps.begin("charts", 0.6);
  const Eigen::VectorXf resolution = patchResolutions(patches, views.projectors, choice.view);
  const std::vector<Chart> charts = makeAtlas(patches, resolution, options, result, part.faces);

  steps.begin("seams", 0.7);
  Blend blend = blendViews({patches, candidates, choice.view, choice.photometry, choice.consistency.penalties},
                           {part.blend_rounds, options.level, options.threads, part.border});

  steps.begin("painting", 0.8);
  const std::vector<TexelSlot> slots = texelSlots(charts, patches.size());
  const PaintScene scene{patches, charts, choice.view, slots, options.threads};
  const PaintSources sources{
      views.projectors, views.photos, choice.photometry, blend, candidates, choice.consistency.penalties, outlines};
  paintPhotographs(scene, sources, choice.view, part.patches, job);
  blend = {}; // back-projection needs the memory
  choice.surface.outlines = {};

  steps.begin("back-projection", 0.85);
  if (options.exposure)
    backProject(scene, sources, {options.rounds, ofParts(registrationErrors(result), views.owner)}, atlases);

  steps.begin("inpainting", 0.9);
  const std::vector<char> clipped = clippedPatches(scene, candidates);
  const Points around = diffuseColors(patches, knownColors(scene, part, atlases), clipped, options.threads);
  paintUnseen(scene, around, atlases, result.masks);
  continueClipped(scene, sources, clipped, around, atlases);

  steps.begin("gaps", 0.98);
  fillGaps(charts, options.threads, atlases);
  return part.fill_colors ? takeOwn(scene, part, result) : Points();
}
} // namespace fresco::texture
