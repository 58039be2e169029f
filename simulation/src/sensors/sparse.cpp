// SPDX-License-Identifier: BSD-3-Clause
#include "sensors/sparse.h"
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/similarity.h>
#include <fresco/simulation/sensors/random.h>
#include <iomanip>
#include <optional>
#include <sstream>
namespace fresco::simulation {
using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {
struct Sight {
  RayHit hit;
  Vector3f at = Vector3f::Zero(); ///< metres, in the coordinates of the scene's mesh
};

Sight look(const LitScene& lit, const View& view, const Vector3d& beam_camera)
{
  const Vector3f eye = (view.center() - lit.scene.mesh.origin).cast<float>(),
                 beam = (view.T_camera_world.linear().transpose() * beam_camera).cast<float>();
  const RayHit hit = lit.rays.intersect(Ray{eye, beam});
  return {hit, hit.face < 0 ? eye : Vector3f(eye + hit.distance * beam)};
}

/// Whether the surface has a pattern there that a feature detector would find, by chance in proportion to its contrast.
bool isDistinct(const LitScene& lit, const CameraModel& camera, const View& view, const Eigen::Vector2d& pixel,
                CounterRandom& random)
{
  constexpr float clear = 0.08f, least = 0.04f; // differences of display values; chance of a place without any
  constexpr double step = 3;                    // pixels, about the size of the smallest features
  float contrast = 0;
  const Sight middle = look(lit, view, unproject(camera, pixel));
  if (middle.hit.face < 0)
    return false;
  const Vector3f color = surfaceColor(lit, middle.hit, 0.004f);
  for (const Eigen::Vector2d& offset : {Eigen::Vector2d(step, 0), Eigen::Vector2d(0, step)}) {
    const Sight beside = look(lit, view, unproject(camera, pixel + offset));
    if (beside.hit.face >= 0)
      contrast = std::max(contrast, (surfaceColor(lit, beside.hit, 0.004f) - color).cwiseAbs().maxCoeff());
  }
  return random.uniformFloat() < std::max(least, contrast / clear);
}

/// Where the view's frame has the place; none if beside it.
std::optional<Eigen::Vector2d> pixelOf(const CameraSet& set, int view, const Vector3d& place)
{
  const CameraModel& camera = set.cameras[set.views[view].camera];
  const Vector3d q = set.views[view].T_camera_world * place;
  if (!(q.z() > 0.1))
    return {};
  const Eigen::Vector2d pixel = project(camera, q);
  if (!(pixel.x() > 0 && pixel.y() > 0 && pixel.x() < camera.width && pixel.y() < camera.height))
    return {};
  return pixel;
}

/// Views that show the place, first of all `first`.
std::vector<Observation> observe(const LitScene& lit, const CameraSet& set, int first, const Vector3d& place)
{
  constexpr std::size_t most = 8; // photographs that match
  std::vector<Observation> track;
  const int count = static_cast<int>(set.views.size());
  for (int k = 0; k < count && track.size() < most; ++k) {
    const int v = (first + k) % count;
    const auto pixel = pixelOf(set, v, place);
    if (!pixel)
      continue;
    const Vector3d q = set.views[v].T_camera_world * place;
    const Sight sight = look(lit, set.views[v], q / q.z());
    if (sight.hit.face >= 0 && std::abs(sight.hit.distance / q.z() - 1) < 0.01)
      track.push_back({v, *pixel});
  }
  return track;
}

/// Matches of things that only look alike: a place elsewhere on the first ray, and a track that agrees on it.
void makeWrong(const CameraSet& set, SparsePoint& point, CounterRandom& random)
{
  constexpr int most_draws = 20; // places that one photograph alone shows are no points
  const Vector3d eye = set.views[point.track[0].view].center(), right = point.position;
  std::vector<Observation> track;
  for (int draw = 0; draw < most_draws && track.size() < 2; ++draw) {
    point.position = eye + std::exp(random.uniform(-1, 1)) * (right - eye);
    track.clear();
    for (const Observation& observation : point.track)
      if (const auto pixel = pixelOf(set, observation.view, point.position))
        track.push_back({observation.view, *pixel});
  }
  point.track = track;
}

/// One try; without a track where it fails.
SparsePoint tryPoint(const LitScene& lit, const CameraSet& set, const DatasetOptions& o, Index number)
{
  CounterRandom random(o.seed, 71, number);
  SparsePoint point;
  const int v = random.integer(static_cast<int>(set.views.size()));
  const View& view = set.views[v];
  const CameraModel& camera = set.cameras[view.camera];
  const double x = random.uniform(0, camera.width), y = random.uniform(0, camera.height);
  if (!isDistinct(lit, camera, view, {x, y}, random))
    return point;
  const Sight sight = look(lit, view, unproject(camera, {x, y}));
  const Vector3d place = sight.at.cast<double>() + lit.scene.mesh.origin;
  point.track = observe(lit, set, v, place);
  if (point.track.size() < 2)
    return SparsePoint();
  point.color = (255 * surfaceColor(lit, sight.hit, 0.004f).array().min(1.f)).round().cast<std::uint8_t>();
  point.position = place;
  for (double& coordinate : point.position)
    coordinate += o.sparse_noise * random.gaussian();
  if (random.uniform() < o.sparse_outliers)
    makeWrong(set, point, random);
  if (point.track.size() < 2)
    return SparsePoint();
  for (Observation& observation : point.track) {
    const Eigen::Vector2d noise(0.5 * random.gaussian(), 0.5 * random.gaussian()); // pixels: as features are found
    observation.pixel += noise;
    point.error += noise.norm() / static_cast<double>(point.track.size());
  }
  return point;
}
} // namespace

ScenePlaces partAlongX(const ScenePlaces& samples, double share)
{
  const float low = samples.positions.row(0).minCoeff(), high = samples.positions.row(0).maxCoeff();
  std::vector<Index> kept;
  for (Index i = 0; i < samples.positions.cols(); ++i)
    if (samples.positions(0, i) <= low + share * (high - low))
      kept.push_back(i);
  return {samples.positions(Eigen::all, kept), samples.normals(Eigen::all, kept)};
}

SparsePoints sparsePoints(const LitScene& lit, const CameraSet& set, const DatasetOptions& options)
{
  constexpr Index most_tries = 200; // per point, where hardly any place is seen twice
  SparsePoints points;
  std::vector<SparsePoint> tried(options.sparse);
  for (Index round = 0; round < most_tries && points.size() < tried.size(); ++round) {
    parallelFor(tried.size(), options.threads,
                [&](Index i) { tried[i] = tryPoint(lit, set, options, round * options.sparse + i); });
    for (std::size_t i = 0; i < tried.size() && points.size() < tried.size(); ++i)
      if (!tried[i].track.empty())
        points.push_back(tried[i]);
  }
  return points;
}

std::string intoOwnFrame(CameraSet& set, SparsePoints& points, int seed)
{
  CounterRandom random(seed, 73, 0);
  Eigen::Vector4d q;
  for (double& value : q)
    value = random.gaussian();
  Similarity T_own_world;
  T_own_world.scale = std::pow(10, random.uniform(-2, 2));
  T_own_world.R = Eigen::Quaterniond(q.normalized()).toRotationMatrix();
  for (double& value : T_own_world.t)
    value = T_own_world.scale * random.uniform(-20, 20);
  transformCameras(T_own_world, set, points);
  std::ostringstream text;
  text << std::setprecision(17) << T_own_world.inverse().matrix() << "\n";
  return text.str();
}
} // namespace fresco::simulation
