// SPDX-License-Identifier: BSD-3-Clause
#include "cameras/camera_refinement.h"
#include "cameras/camera_adjustment.h"
#include <algorithm>
#include <fresco/core/parallel.h>
#include <fresco/core/statistics.h>
#include <tuple>
namespace fresco::texture {
namespace {
auto numbersOf(const CameraModel& c)
{
  return std::tie(c.width, c.height, c.fx, c.fy, c.cx, c.cy, c.k1, c.k2, c.p1, c.p2);
}

CameraState stateOf(const TriangleMesh& mesh, const std::vector<TextureView>& views)
{
  CameraState state;
  for (const TextureView& view : views) {
    const auto same = [&](const CameraModel& c) { return numbersOf(c) == numbersOf(view.camera); };
    const auto at = std::find_if(state.cameras.begin(), state.cameras.end(), same);
    state.group.push_back(at - state.cameras.begin());
    if (at == state.cameras.end())
      state.cameras.push_back(view.camera);
    state.T_camera_mesh.push_back(view.T_camera_world * Eigen::Translation3d(mesh.origin));
  }
  return state;
}

/// Grey copies take at most half of what may be kept of the photographs; the rest keeps what they are made of.
std::vector<MatchPhoto> prepare(PhotoStore& photos, Index count, int threads)
{
  constexpr Index most_pixels = 1 << 20;  // of a photograph that is searched: bounds the time
  constexpr Index least_pixels = 1 << 16; // coarser, half a pixel is too much of the photograph
  constexpr int levels = 4;               // the widest search becomes one of few pixels
  constexpr int corner_cells = 200;       // per photograph: many times the unknowns of a camera
  constexpr double with_halvings = 4.0 / 3;
  const double share = 0.5 * photos.mostBytes() / (with_halvings * count);
  const Index pixels = std::clamp<double>(share, least_pixels, most_pixels);
  photos.setAside(with_halvings * (pixels * count));
  std::vector<MatchPhoto> out(count);
  parallelFor(
      count, threads,
      [&](Index v) {
        out[v].pyramid = buildPyramid(*photos.get(v), pixels, levels);
        out[v].corners = findCorners(out[v].pyramid.levels[0], corner_cells);
      },
      1);
  return out;
}

/// Spread over all pairs of views; more would not make the cameras better.
std::vector<PhotoMatch> thinned(const std::vector<PhotoMatch>& matches, std::size_t views)
{
  constexpr std::size_t per_view = 200; // many times the 6 unknowns of a pose
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
} // namespace

RefinedCameras refineCameras(const RefinementInput& input, int threads, const Progress& progress)
{
  constexpr double searches[] = {0.06, 0.025, 0.0125, 0.008}; // of the image's width: shrinks with what is left to find
  constexpr double least_gain = 0.9;                          // of the error: a smaller gain may be chance
  constexpr Index least_matches = 50;                         // for a median, and for priors not to be all that decides
  const Index views = input.views.size();
  const CameraState initial = stateOf(input.mesh, input.views);
  CameraState state = initial;
  RefinedCameras out;
  const std::vector<MatchPhoto> prepared = prepare(input.photos, views, threads);
  MatchOptions options;
  options.threads = threads;
  double done = 0;
  for (const double search : searches) {
    report(progress, "camera refinement", done);
    options.search = search * widestOf(state);
    const std::vector<PhotoMatch> matches = matchPhotos(input.scene, prepared, state, options);
    out.matches = matches.size();
    if (out.matches < least_matches)
      break;
    out.before = medianError(matches, initial);
    if (done == 0 && out.before < agreement_pixels) {
      out.after = out.before;
      break;
    }
    state = adjustCameras(thinned(matches, views), initial, priorFor(medianDistance(matches, initial)), threads);
    out.after = medianError(matches, state);
    done += 1.0 / std::size(searches);
  }
  input.photos.setAside(0);
  out.changed = out.matches >= least_matches && out.after < least_gain * out.before;
  if (!out.changed)
    state = initial;
  for (Index v = 0; v < views; ++v) {
    out.cameras.push_back(state.cameras[state.group[v]]);
    out.T_camera_world.push_back(state.T_camera_mesh[v] * Eigen::Translation3d(-input.mesh.origin));
  }
  return out;
}
} // namespace fresco::texture
