// SPDX-License-Identifier: BSD-3-Clause
#include "photograph_matches.h"
#include "rotation_search.h"
#include "similarity_refinement.h"
#include "similarity_votes.h"
#include <algorithm>
#include <cmath>
#include <fresco/alignment/core/camera_alignment.h>
#include <fresco/core/constants.h>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <numeric>
#include <optional>
namespace fresco {
using namespace alignment;
namespace {
using Eigen::Vector3d;

/// A place of the model on the surface.
struct Place {
  Similarity T_surface_model;
  PlaceCheck check;
  double score = 0;
};

/// What all places are judged on.
struct Scene {
  const SparseModel& model;
  const ScanSurface& surface;
  const CameraAlignmentOptions& options;
};

void validate(const CameraSet& set, const SparsePoints& points, const CameraAlignmentOptions& options)
{
  require(options.min_support > 0 && options.min_support <= 1, "camera alignment: min_support ", options.min_support,
          " is not in 0..1");
  require(options.max_alias > 0 && options.max_alias <= 1, "camera alignment: max_alias ", options.max_alias,
          " is not in 0..1");
  for (const View& view : set.views)
    require(view.T_camera_world.matrix().allFinite(), "camera alignment: the pose of ", view.image, " is not finite");
  for (const SparsePoint& point : points) {
    require(point.position.allFinite(), "camera alignment: a sparse point is not finite");
    for (const Observation& observation : point.track)
      require(observation.view >= 0 && observation.view < static_cast<int>(set.views.size()),
              "camera alignment: a track names view ", observation.view, " of ", set.views.size());
  }
}

/// How far apart two places bring the model, in its unit: the farthest of points on the sphere that half of it lies in.
double distanceOf(const Similarity& a, const Similarity& b)
{
  double most = 0;
  for (int k = 0; k < 7; ++k) {
    const Vector3d x = k == 6 ? Vector3d::Zero() : Vector3d((k < 3 ? 1 : -1) * Vector3d::Unit(k % 3));
    most = std::max(most, (a * x - b * x).norm());
  }
  return most / std::sqrt(a.scale * b.scale);
}

double scoreOf(const PlaceCheck& check)
{
  return check.support * (1 - check.blocked) * (1 + std::max(0.0, check.colors));
}

/// Best first, one of each group of places that are nearly the same.
void keepDistinct(std::vector<Place>& places, double apart, std::size_t most)
{
  std::stable_sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.score > b.score; });
  std::vector<Place> kept;
  for (const Place& place : places)
    if (kept.size() < most && std::none_of(kept.begin(), kept.end(), [&](const Place& other) {
          return distanceOf(place.T_surface_model, other.T_surface_model) < apart;
        }))
      kept.push_back(place);
  places = kept;
}

/// The best of the places that are clearly another than the first; null = none.
const Place* nextPlace(const std::vector<Place>& places)
{
  constexpr double apart = 0.1; // of the model's radius: within it, refinement may stop short of one place
  for (const Place& place : places)
    if (distanceOf(place.T_surface_model, places[0].T_surface_model) > apart)
      return &place;
  return nullptr;
}

/// Refined on points spread evenly, and sorted out by how many of these come to lie on the surface.
std::vector<Place> coarsePlaces(const Scene& scene, const std::vector<VotedSimilarity>& voted)
{
  constexpr std::size_t most = 600, kept = 40;
  constexpr Index most_points = 400;
  std::vector<Index> points;
  const Index count = scene.model.spread.size(), n = std::min(most_points, count);
  for (Index i = 0; i < n; ++i)
    points.push_back(scene.model.spread[i * count / n]);
  SparseModel thinned = scene.model;
  thinned.points = scene.model.points(Eigen::all, points);
  thinned.eyes = scene.model.eyes(Eigen::all, points);
  thinned.colors = scene.model.colors(Eigen::all, points);
  std::vector<Index> all(points.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<Place> places(std::min(most, voted.size()));
  parallelFor(
      places.size(), scene.options.threads,
      [&](Index i) {
        Place& place = places[i];
        place.T_surface_model =
            refineSimilarity(thinned, all, scene.surface, {1.5 * vote_cell, 0.4 * vote_cell}, voted[i].T_surface_model);
        place.check = checkPlace(thinned, scene.surface, place.T_surface_model, 0.4 * vote_cell);
        place.score = scoreOf(place.check);
      },
      1);
  keepDistinct(places, 2 * vote_cell, kept);
  return places;
}

/// Refined on all points to their noise, which is that of the best place, and judged.
void finishPlaces(const Scene& scene, std::vector<Place>& places, double start)
{
  if (places.empty())
    return;
  std::vector<Index> all(scene.model.points.cols());
  std::iota(all.begin(), all.end(), 0);
  const auto refineAll = [&](const RefinementRange& range) {
    parallelFor(
        places.size(), scene.options.threads,
        [&](Index i) {
          Place& place = places[i];
          place.T_surface_model = refineSimilarity(scene.model, all, scene.surface, range, place.T_surface_model);
          place.check = checkPlace(scene.model, scene.surface, place.T_surface_model, range.end);
          place.score = scoreOf(place.check);
        },
        1);
    keepDistinct(places, 0.5 * vote_cell, places.size());
  };
  refineAll({start, 0.2 * vote_cell});
  const double noise = noiseOf(scene.model, scene.surface, places[0].T_surface_model, 0.4 * vote_cell),
               least = 0.1 * scene.surface.grain() / places[0].T_surface_model.scale;
  refineAll({0.2 * vote_cell, std::max(3 * noise, least)});
}

/// The same place, by where the pixels of the tracks see the points: that is free of the noise of their coordinates.
Similarity refinedByTracks(const Scene& scene, const Similarity& T_surface_model)
{
  SparseModel seen = scene.model;
  seen.points = scene.model.seen;
  std::vector<Index> all(seen.points.cols());
  std::iota(all.begin(), all.end(), 0);
  const Similarity T =
      refineSimilarity(seen, all, scene.surface, {0.2 * vote_cell, 0.1 * vote_cell, true}, T_surface_model);
  const double noise = noiseOf(seen, scene.surface, T, 0.2 * vote_cell), least = 0.1 * scene.surface.grain() / T.scale;
  return refineSimilarity(seen, all, scene.surface, {0.1 * vote_cell, std::max(3 * noise, least), true}, T);
}

/// Whether the cameras stand in the frame of the scans as they are.
std::optional<Place> givenPlace(const Scene& scene)
{
  constexpr double most_move = 0.05; // of the model's radius: what refinement may still find wrong with given cameras
  constexpr double most_scale = 100; // of the scans' radius to that of the model: a part of them
  Similarity T = scene.model.T_model_cameras.inverse();
  T.t -= scene.surface.center();
  if (!(scene.surface.radius() < most_scale * T.scale && T.scale < most_scale * scene.surface.radius()))
    return {};
  std::vector<Place> places{{T, {}, 0}};
  finishPlaces(scene, places, vote_cell);
  if (places[0].check.support < scene.options.min_support || distanceOf(places[0].T_surface_model, T) > most_move)
    return {};
  return places[0];
}

/// The best place, and how good the next one is.
/// @param T_surface_model the best place as refined
CameraAlignmentResult resultOf(const Scene& scene, const std::vector<Place>& places, const Similarity& T_surface_model)
{
  const Place& best = places[0];
  CameraAlignmentResult result;
  result.T_scans_cameras = T_surface_model * scene.model.T_model_cameras;
  result.T_scans_cameras.t += scene.surface.center();
  result.support = best.check.support;
  result.blocked = best.check.blocked;
  result.rms = best.check.rms * best.T_surface_model.scale;
  if (const Place* const other = nextPlace(places))
    result.alias = other->score / best.score;
  return result;
}

/// Places of all rotations and of scales in a range, best first.
/// @param sizes of the model, in units of the surface's radius
std::vector<Place> findPlaces(const Scene& scene, const std::vector<Eigen::Matrix3d>& rotations,
                              const std::pair<double, double>& sizes, const Progress& progress)
{
  const double radius = scene.surface.radius();
  const auto voted =
      voteForSimilarities(scene.model, scene.surface, rotations, {sizes.first * radius, sizes.second * radius},
                          scene.options.threads, subProgress(progress, 0.0, 0.8));
  report(progress, "refinement", 0.8);
  std::vector<Place> places = coarsePlaces(scene, voted);
  finishPlaces(scene, places, 0.5 * vote_cell);
  return places;
}

[[noreturn]] void refuseAmbiguous(const std::vector<Place>& places, double alias)
{
  const Similarity &a = places[0].T_surface_model, &b = nextPlace(places)->T_surface_model;
  const double turn = Eigen::AngleAxisd(a.R * b.R.transpose()).angle() * degrees_per_radian;
  throw std::runtime_error(concat("ambiguous: the sparse points fit two places about as well, the second (",
                                  std::lround(100 * alias), " % as good) turned by ", std::lround(turn),
                                  " degrees, scaled by ", std::round(100 * b.scale / a.scale) / 100,
                                  " against the first: the scene looks alike from several sides"));
}

/// The place that matches between photographs and views of the scans single out.
std::optional<CameraAlignmentResult> matchedPlace(const Scene& scene, const CameraSet& set, const SparsePoints& points,
                                                  const SurfacePainter& painter, const Progress& progress)
{
  constexpr double most_votes_next = 0.5;             // of what no place but the best explains: the scene may repeat
  constexpr std::pair<double, double> sizes(0.04, 2); // of the model, in units of the surface's radius
  const double unit = scene.model.T_model_cameras.scale, radius = scene.surface.radius();
  const auto matches = matchPhotographs(set, points, painter, scene.surface, scene.options, progress);
  const auto found = agreeOnSimilarities(matches, points, {sizes.first * radius * unit, sizes.second * radius * unit},
                                         vote_cell / unit);
  const double alias = double(found[1].votes) / std::max<Index>(1, found[0].votes);
  if (found[0].votes < fewest_known || alias > most_votes_next)
    return {};
  std::vector<Place> places{{found[0].T_surface_cameras * scene.model.T_model_cameras.inverse(), {}, 0}};
  const Similarity matched = places[0].T_surface_model;
  finishPlaces(scene, places, vote_cell);
  const bool slides = distanceOf(places[0].T_surface_model, matched) > 2 * vote_cell; // shape holds too little
  if (slides)
    places = {{matched, checkPlace(scene.model, scene.surface, matched, 0.4 * vote_cell), 1}};
  if (places[0].check.support < scene.options.min_support)
    return {};
  CameraAlignmentResult result =
      resultOf(scene, places, slides ? matched : refinedByTracks(scene, places[0].T_surface_model));
  result.matches = found[0].votes;
  result.alias = alias;
  return result;
}
/// The place that shape alone tells.
CameraAlignmentResult placeByShape(const Scene& scene, const Progress& progress)
{
  // Most models show most of a room. The smaller the part, the more places there are for it to fit by chance.
  constexpr std::pair<double, double> sizes[] = {{0.25, 1.4}, {0.08, 0.25}};
  report(progress, "rotation", 0.0);
  std::vector<Eigen::Matrix3d> rotations;
  if (scene.model.order.size() >= fewest_known)
    rotations = findRotations(scene.model, scene.surface, scene.options.threads);
  double most = 0, begin = 0.1;
  for (const auto& range : sizes) {
    const std::vector<Place> places = findPlaces(scene, rotations, range, subProgress(progress, begin, begin + 0.45));
    begin += 0.45;
    if (places.empty())
      continue;
    const CameraAlignmentResult result = resultOf(scene, places, refinedByTracks(scene, places[0].T_surface_model));
    most = std::max(most, result.support);
    if (result.support < scene.options.min_support)
      continue;
    if (result.alias > scene.options.max_alias)
      refuseAmbiguous(places, result.alias);
    return result;
  }
  throw std::runtime_error(
      concat("no place fits: at the best one ", std::lround(100 * most),
             " % of the sparse points lie on the surface of the scans in sight of their cameras (",
             std::lround(100 * scene.options.min_support),
             " are wanted); the photographs show something else, or most of their points are wrong"));
}

void requireEnough(Index sparse_points)
{
  if (sparse_points < fewest_sparse_points)
    throw std::runtime_error(concat(sparse_points, " sparse points are too few, at least ", fewest_sparse_points,
                                    " are wanted to find where the cameras stand"));
}
} // namespace

CameraAlignmentResult alignCameras(const CameraSet& set, const SparsePoints& points, const PointSet& surface_points,
                                   const CameraAlignmentOptions& options, const Progress& progress)
{
  validate(set, points, options);
  requireEnough(points.size());
  report(progress, "surface", 0.0);
  const ScanSurface surface(surface_points, options.threads);
  const SparseModel model = makeSparseModel(set, points, options.threads);
  requireEnough(model.points.cols());
  const Scene scene{model, surface, options};
  if (const auto given = givenPlace(scene)) {
    CameraAlignmentResult result = resultOf(scene, {*given}, given->T_surface_model);
    result.T_scans_cameras = Similarity();
    result.already_aligned = true;
    return result;
  }
  if (options.photograph)
    if (const SurfacePainter painter(surface_points, surface); painter.hasGray())
      if (const auto matched = matchedPlace(scene, set, points, painter, subProgress(progress, 0.05, 0.4)))
        return *matched;
  return placeByShape(scene, subProgress(progress, options.photograph ? 0.4 : 0.05, 1.0));
}
} // namespace fresco
