// SPDX-License-Identifier: BSD-3-Clause
#include "cameras/camera_refinement.h"
#include "cameras/camera_adjustment.h"
#include <algorithm>
#include <fresco/core/parallel.h>
#include <tuple>
namespace fresco::texture {
namespace {
constexpr Index most_pixels = 1 << 20, least_pixels = 1 << 16; // of a photograph that is searched
constexpr int pyramid_levels = 4, corner_cells = 200;
constexpr double searches[] = {0.06, 0.025, 0.0125, 0.008}; // of the image's width, round by round
constexpr double agreement = 0.5;                           // pixels: cameras that agree so well are left alone
constexpr double least_gain = 0.9;                          // of the error
constexpr Index least_matches = 50;

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
    state.group.push_back(static_cast<int>(at - state.cameras.begin()));
    if (at == state.cameras.end())
      state.cameras.push_back(view.camera);
    state.T_camera_mesh.push_back(view.T_camera_world * Eigen::Translation3d(mesh.origin));
  }
  return state;
}

/// Grey copies take at most half of what may be kept of the photographs; the rest keeps what they are made of.
std::vector<MatchPhoto> prepare(PhotoStore& photos, Index count, int threads)
{
  constexpr double with_halvings = 4.0 / 3;
  const double share = 0.5 * static_cast<double>(photos.mostBytes()) / (with_halvings * static_cast<double>(count));
  const auto pixels = static_cast<Index>(std::clamp<double>(share, least_pixels, most_pixels));
  photos.setAside(static_cast<std::size_t>(with_halvings * static_cast<double>(pixels * count)));
  std::vector<MatchPhoto> out(count);
  parallelFor(
      count, threads,
      [&](Index v) {
        out[v].pyramid = buildPyramid(*photos.get(v), pixels, pyramid_levels);
        out[v].corners = findCorners(out[v].pyramid.levels[0], corner_cells);
      },
      1);
  return out;
}

/// Spread over all pairs of views; more would not make the cameras better.
std::vector<PhotoMatch> thinned(const std::vector<PhotoMatch>& matches, std::size_t views)
{
  constexpr std::size_t per_view = 200;
  const std::size_t most = per_view * views;
  if (matches.size() <= most)
    return matches;
  std::vector<PhotoMatch> out;
  for (std::size_t i = 0; i < most; ++i)
    out.push_back(matches[i * matches.size() / most]);
  return out;
}

double medianOf(std::vector<double> values)
{
  if (values.empty())
    return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

double medianDistance(const std::vector<PhotoMatch>& matches, const CameraState& state)
{
  std::vector<double> distances;
  for (const PhotoMatch& match : matches)
    distances.push_back((state.T_camera_mesh[match.from] * match.point).z());
  return medianOf(distances);
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

RefinedCameras refineCameras(const TriangleMesh& mesh, const RayScene& scene, const std::vector<TextureView>& views,
                             PhotoStore& photos, int threads, const Progress& progress)
{
  const CameraState initial = stateOf(mesh, views);
  CameraState state = initial;
  RefinedCameras out;
  const std::vector<MatchPhoto> prepared = prepare(photos, static_cast<Index>(views.size()), threads);
  MatchOptions options;
  options.threads = threads;
  double done = 0;
  for (const double search : searches) {
    report(progress, "camera refinement", done);
    options.search = search * widestOf(state);
    const std::vector<PhotoMatch> matches = matchPhotos(scene, prepared, state, options);
    out.matches = static_cast<Index>(matches.size());
    if (out.matches < least_matches)
      break;
    out.before = medianOf(matchErrors(matches, initial));
    if (done == 0 && out.before < agreement) {
      out.after = out.before;
      break;
    }
    state = adjustCameras(thinned(matches, views.size()), initial, priorFor(medianDistance(matches, initial)), threads);
    out.after = medianOf(matchErrors(matches, state));
    done += 1.0 / std::size(searches);
  }
  photos.setAside(0);
  out.changed = out.matches >= least_matches && out.after < least_gain * out.before;
  if (!out.changed)
    state = initial;
  for (std::size_t v = 0; v < views.size(); ++v) {
    out.cameras.push_back(state.cameras[state.group[v]]);
    out.T_camera_world.push_back(state.T_camera_mesh[v] * Eigen::Translation3d(-mesh.origin));
  }
  return out;
}
} // namespace fresco::texture
