// SPDX-License-Identifier: BSD-3-Clause
#include "cameras/camera_refinement.h"
#include "cameras/camera_adjustment.h"
#include "photographs/input_checks.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/core/statistics.h>
#include <iomanip>
#include <tuple>
namespace fresco::texture {
namespace {
/// Cameras that agree so well are left alone: half a pixel is what matching itself errs by.
constexpr double agreement_pixels = 0.5;

auto numbersOf(const CameraModel& c)
{
  return std::tie(c.width, c.height, c.fx, c.fy, c.cx, c.cy, c.k1, c.k2, c.p1, c.p2, c.k3, c.k4, c.k5, c.k6, c.sx1,
                  c.sy1, c.sx2, c.sy2, c.r8, c.omega, c.skew, c.projection);
}

CameraState stateOf(const TriangleMesh& mesh, const std::vector<ViewPart>& views)
{
  CameraState state;
  for (const ViewPart& view : views) {
    std::size_t g = 0;
    while (g < state.cameras.size() &&
           !(numbersOf(state.cameras[g]) == numbersOf(view.camera) && bool(state.fixed_lens[g]) == view.ofPanorama()))
      ++g;
    if (g == state.cameras.size()) {
      state.cameras.push_back(view.camera);
      state.fixed_lens.push_back(view.ofPanorama());
    }
    state.group.push_back(g);
    state.T_camera_mesh.push_back(view.R_part_view * (view.given->T_camera_world * Eigen::Translation3d(mesh.origin)));
    state.pose.push_back(view.view);
    state.R_part_view.push_back(view.R_part_view);
  }
  return state;
}

void applyMask(const Image& mask, MatchPhoto& photo)
{
  if (mask.empty())
    return;
  const Image& level = photo.pyramid.levels[0];
  photo.used.reserve(cellCount(level.width, level.height));
  for (int y = 0; y < level.height; ++y)
    for (int x = 0; x < level.width; ++x)
      photo.used.push_back(*mask.pixel(std::min<int>((x + 0.5) / photo.pyramid.scale, mask.width - 1),
                                       std::min<int>((y + 0.5) / photo.pyramid.scale, mask.height - 1)) > 0);
  auto& corners = photo.corners;
  corners.erase(std::remove_if(corners.begin(), corners.end(), [&](const auto& c) { return !photo.uses(c); }),
                corners.end());
}

/// Grey copies take at most half of what may be kept of the photographs; the rest keeps what they are made of.
std::vector<MatchPhoto> prepare(PhotoStore& photos, const std::vector<ViewPart>& views, int threads)
{
  const Index count = views.size();
  constexpr Index most_pixels = 1 << 20;  // of a photograph that is searched: bounds the time
  constexpr Index least_pixels = 1 << 16; // coarser, half a pixel is too much of the photograph
  constexpr int corner_cells = 400; // per photograph: many times the unknowns of a camera where a fifth is matched
  constexpr double with_halvings = 4.0 / 3;
  const double share = 0.5 * photos.mostBytes() / (with_halvings * count);
  const Index pixels = std::clamp<double>(share, least_pixels, most_pixels);
  std::size_t fine_bytes = 0;
  for (const ViewPart& view : views)
    if (const Index own = Index(view.camera.width) * view.camera.height; own > pixels)
      fine_bytes += std::min(own, 4 * pixels);
  const std::size_t bytes = with_halvings * (pixels * count);
  const bool fine = bytes + fine_bytes <= 0.5 * photos.mostBytes();
  photos.setAside(bytes + (fine ? fine_bytes : 0));
  std::vector<MatchPhoto> out(count);
  const auto prepareOne = [&](Index v) {
    out[v].pyramid = buildPyramid(*photos.get(v), {pixels, fine});
    out[v].corners = findCorners(out[v].pyramid.levels[0], corner_cells);
    applyMask(withinReach(photos.mask(v)), out[v]);
  };
  parallelFor(count, threads, prepareOne, 1);
  return out;
}

/// Spread over all pairs of views; more would not make the cameras better.
std::vector<PhotoMatch> thinned(const std::vector<PhotoMatch>& matches, std::size_t views)
{
  constexpr std::size_t per_view = 1000; // what they err by counts a thirtieth
  const std::size_t most = per_view * views;
  if (matches.size() <= most)
    return matches;
  std::vector<PhotoMatch> out;
  for (std::size_t i = 0; i < most; ++i)
    out.push_back(matches[i * matches.size() / most]);
  return out;
}

double medianError(const std::vector<PhotoMatch>& matches, const CameraState& state)
{
  return median(matchErrors(matches, state));
}

double medianDistance(const std::vector<PhotoMatch>& matches, const CameraState& state)
{
  std::vector<double> distances;
  for (const PhotoMatch& match : matches)
    distances.push_back((state.T_camera_mesh[match.from] * match.point).z());
  return median(distances);
}

/// Shifts scale with the distance of what is seen, because the mesh's unit is unknown.
AdjustmentPrior priorFor(double distance)
{
  AdjustmentPrior prior;
  prior.pose_shift = 0.01 * distance;
  prior.mount_shift = 0.04 * distance;
  return prior;
}

int widestOf(const CameraState& state)
{
  int width = 0;
  for (const CameraModel& camera : state.cameras)
    width = std::max(width, camera.width);
  return width;
}

/// Errors of the matches by what was given.
void describeFits(const std::vector<PhotoMatch>& matches, const CameraState& state, TextureResult& result)
{
  const std::vector<double> errors = matchErrors(matches, state);
  std::vector<std::vector<double>> of_view(result.cameras.size());
  for (std::size_t i = 0; i < matches.size(); ++i)
    for (const int view : {matches[i].from, matches[i].to})
      of_view[state.pose[view]].push_back(errors[i]);
  result.fits.resize(of_view.size());
  for (std::size_t v = 0; v < of_view.size(); ++v) {
    std::vector<double>& list = of_view[v];
    std::sort(list.begin(), list.end());
    if (!list.empty())
      result.fits[v] = {static_cast<Index>(list.size()), list[list.size() / 2], list[list.size() * 9 / 10]};
  }
}

/// Leaves the cameras as they are where no correction makes them agree clearly better. Those that agree to half a pixel
/// get one step, by the matches that told so.
void refineCameras(const RefinementInput& input, int threads, const Progress& progress, TextureResult& result)
{
  constexpr double searches[] = {0.06, 0.025, 0.0125, 0.008}; // of the image's width: shrinks with what is left to find
  constexpr double least_pixels = 0.05;                       // a smaller gain may be chance
  constexpr std::size_t least_matches = 50;                   // for a median, and for priors not to be all that decides
  double &before = result.disagreement_before, &after = result.disagreement_after;
  const std::size_t views = input.views.size();
  const CameraState initial = stateOf(input.mesh, input.views);
  CameraState state = initial;
  const std::vector<MatchPhoto> prepared = prepare(input.photos, input.views, threads);
  std::vector<PhotoMatch> matches;
  MatchOptions options;
  options.threads = threads;
  const auto match = [&](double search) {
    options.search = search * widestOf(initial);
    matches = matchPhotos(input.scene, prepared, state, options);
    return matches.size() >= least_matches;
  };
  const auto adjust = [&] {
    before = medianError(matches, initial);
    state = adjustCameras(thinned(matches, views), initial, priorFor(medianDistance(matches, initial)), threads);
    after = medianError(matches, state);
  };
  if (match(*std::rbegin(searches)) && medianError(matches, initial) < agreement_pixels)
    adjust(); // nothing lies farther away than what was found
  else
    for (std::size_t round = 0; round < std::size(searches); ++round) {
      report(progress, "camera refinement", double(round) / std::size(searches));
      if (!match(searches[round]))
        break;
      adjust();
    }
  input.photos.setAside(0);
  result.refined = matches.size() >= least_matches && after < std::min(clear_gain * before, before - least_pixels);
  if (!result.refined)
    after = before;
  if (matches.size() >= least_matches)
    describeFits(matches, result.refined ? state : initial, result);
  for (std::size_t v = 0; v < views && result.refined; ++v) {
    PlacedCamera& camera = result.cameras[state.pose[v]];
    if (!input.views[v].ofPanorama())
      camera.camera = state.cameras[state.group[v]];
    camera.T_camera_world =
        state.R_part_view[v].transpose() * (state.T_camera_mesh[v] * Eigen::Translation3d(-input.mesh.origin));
  }
}
} // namespace

void placeCameras(const RefinementInput& input, const TextureOptions& options, const Progress& progress,
                  TextureResult& result)
{
  constexpr std::size_t most_views = 4000; // each is compared with all others for those that show the same
  for (const ViewPart& part : input.views)
    if (part.view == Index(result.cameras.size()))
      result.cameras.push_back({part.given->camera, part.given->T_camera_world});
  const std::size_t views = result.cameras.size();
  if (options.refine && views > most_views)
    result.warnings.push_back(
        concat("cameras are taken as given: ", views, " views are more than the ", most_views, " that are refined"));
  else if (options.refine && views >= 2)
    refineCameras(input, options.threads, progress, result);
}

std::vector<double> misfits(const TextureResult& result)
{
  std::vector<double> out(result.cameras.size(), 0);
  const double expected = std::max(agreement_pixels, result.disagreement_after);
  for (std::size_t v = 0; v < result.fits.size(); ++v)
    if (result.fits[v].matches >= fewest_samples)
      out[v] = std::max(std::log2(result.fits[v].median / expected), 0.0);
  return out;
}

void warnOfMisfits(const std::vector<ViewPart>& parts, TextureResult& result)
{
  const std::vector<double> octaves = misfits(result);
  const auto off = [&](int view) {
    return octaves[view] >= 1 ? concat(" by ", std::fixed, std::setprecision(1), result.fits[view].median, " pixels")
                              : "";
  };
  warnOf(parts, off, {"photographs that do not fit the others and are avoided: ", "", ""}, result);
}

double poseUncertainty(const TextureResult& result)
{
  constexpr double vague = 0.7; // pixels: a disagreement that shows
  constexpr double least = 0.2; // the mesh itself stays uncertain
  const double uncertainty = (result.disagreement_after - exact_pixels) / (vague - exact_pixels);
  return result.disagreement_before > 0 ? std::clamp(uncertainty, least, 1.0) : 1.0;
}

std::vector<float> registrationErrors(const TextureResult& result)
{
  std::vector<float> out;
  for (const PhotographFit& fit : result.fits) {
    const double median = fit.matches >= fewest_samples ? fit.median : result.disagreement_after;
    out.push_back(std::max(0.0, median - exact_pixels));
  }
  return out;
}
} // namespace fresco::texture
