// SPDX-License-Identifier: BSD-3-Clause
#include "scan/viewpoint_search.h"
#include "scan/lists.h"
#include "scan/scan_free_space.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <fresco/core/statistics.h>
#include <limits>
namespace fresco::registration {
namespace {
constexpr Index most_points = 20000; // enough edges of furniture in a room; bounds the time
constexpr int fine_turns = 4;        // of HiddenPoints

Points everyNth(const Points& points, Index most)
{
  const Index n = std::min(most, static_cast<Index>(points.cols()));
  Points few(3, n);
  for (Index k = 0; k < n; ++k)
    few.col(k) = points.col(k * points.cols() / n);
  return few;
}

// How many points lie behind others, as seen from a place: each direction is a cell of a cube map, and cells are about as
// fine as the points are dense. Wider cells let the best place drift by decimetres.
class HiddenPoints {
public:
  // @param turns directions of the cube: the mean over several blurs the borders of the cells
  HiddenPoints(const Points& points, int turns)
      : points_(points), turns_(turns), side_(std::max(4, static_cast<int>(std::sqrt(points.cols() / (6.0 * filling)))))
  {}

  // Share of the points, 0..1.
  double share(const Eigen::Vector3f& place) const
  {
    double sum = 0.0;
    for (int turn = 0; turn < turns_; ++turn)
      sum += share(place, turn);
    return sum / turns_;
  }

private:
  static constexpr double filling = 1.5; // points per cell

  double share(const Eigen::Vector3f& place, int turn) const
  {
    constexpr float behind = 1.17f; // of the nearest range of a cell: a surface seen at a slant reaches less deep
    const Eigen::Matrix3f R =
        Eigen::AngleAxisf(0.7f * turn, Eigen::Vector3f(1.f, 2.f, 3.f).normalized()).toRotationMatrix();
    const Index n = points_.cols();
    std::vector<float> nearest(6 * side_ * side_, std::numeric_limits<float>::infinity()), ranges(n);
    std::vector<Index> cells(n);
    for (Index i = 0; i < n; ++i) {
      const Eigen::Vector3f ray = R * (points_.col(i) - place);
      ranges[i] = ray.norm();
      cells[i] = ranges[i] > 0.f ? cellOnCube(ray, side_, [](float t) { return t; }) : 0;
      nearest[cells[i]] = std::min(nearest[cells[i]], ranges[i]);
    }
    Index hidden = 0;
    for (Index i = 0; i < n; ++i)
      hidden += ranges[i] > behind * nearest[cells[i]] ? 1 : 0;
    return 1.0 * hidden / n;
  }

  const Points& points_;
  int turns_, side_;
};

struct RatedPlace {
  Eigen::Vector3f place;
  double hidden;
  bool operator<(const RatedPlace& other) const { return hidden < other.hidden; }
};

std::vector<RatedPlace> rated(const HiddenPoints& hidden, const std::vector<Eigen::Vector3f>& places, int threads)
{
  return mapTasks(places.size(), threads, [&](Index k) { return RatedPlace{places[k], hidden.share(places[k])}; });
}

// The best places of a grid over the middle of the points.
std::vector<RatedPlace> coarseSearch(const Points& points, int threads)
{
  constexpr Index few = 4000;     // points: their coarse cells see only large surfaces
  constexpr int steps = 7;        // per axis: half a metre in a room, within which the finer search finds the place
  constexpr std::size_t kept = 3; // the best may lie beyond a wall
  constexpr double margin = 0.15; // of the points on either side of a scanner, along each axis
  const Points sparse = everyNth(points, few);
  std::array<std::vector<float>, 3> along;
  for (Index i = 0; i < sparse.cols(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      along[axis].push_back(sparse(axis, i));
  Eigen::Vector3f low, high;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = rankedValue(along[axis], static_cast<std::size_t>(margin * sparse.cols()));
    high[axis] = rankedValue(along[axis], static_cast<std::size_t>((1.0 - margin) * sparse.cols()));
  }
  std::vector<Eigen::Vector3f> places;
  for (int k = 0; k < steps * steps * steps; ++k) {
    const Eigen::Array3f at(k % steps, k / steps % steps, k / steps / steps);
    places.push_back(low + Eigen::Vector3f(at / (steps - 1)).cwiseProduct(high - low));
  }
  std::vector<RatedPlace> candidates = rated(HiddenPoints(sparse, 1), places, threads);
  std::stable_sort(candidates.begin(), candidates.end());
  candidates.resize(kept);
  return candidates;
}

std::vector<Eigen::Vector3f> around(const Eigen::Vector3f& place, float step)
{
  std::vector<Eigen::Vector3f> places;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-step, step})
      places.push_back(place + side * Eigen::Vector3f::Unit(axis));
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3f d(corner & 1 ? 1.f : -1.f, corner & 2 ? 1.f : -1.f, corner & 4 ? 1.f : -1.f);
    places.push_back(place + step * d.normalized());
  }
  return places;
}

// Compass search: to the best of the places around, with half the step where none is better.
RatedPlace descend(const HiddenPoints& hidden, RatedPlace best, float size, int threads)
{
  for (double step = 0.1; step > 0.004; step *= 0.5) // of the size: from the grid's to centimetres in a room
    for (bool moved = true; moved;) {
      const std::vector<RatedPlace> next = rated(hidden, around(best.place, step * size), threads);
      const RatedPlace& least = *std::min_element(next.begin(), next.end());
      moved = least.hidden < best.hidden;
      best = moved ? least : best;
    }
  return best;
}

// Whether hardly anything lies behind other things as seen from a place, and more does as seen from anywhere around.
bool isSeenFrom(const Points& points, const HiddenPoints& hidden, const RatedPlace& candidate, float size, int threads)
{
  constexpr double most_hidden = 0.05;   // from the true place: mixed pixels and surfaces at a slant are half of it
  constexpr double least_coverage = 0.5; // of all directions: scanners of a narrow view stand outside of their points
  constexpr float apart = 0.3f;          // of the size: half a metre in a room, from where more lie behind others
  constexpr double deviations = 3.0;     // of that number: by more than chance,
  constexpr double least_rise = 10.0;    // and by more than the outliers of one beam or edge
  if (candidate.hidden > most_hidden)
    return false;
  const std::vector<RatedPlace> near = rated(hidden, around(candidate.place, apart * size), threads);
  const double there = std::min_element(near.begin(), near.end())->hidden * points.cols();
  return there - candidate.hidden * points.cols() >= least_rise + deviations * std::sqrt(there) &&
         ScanFreeSpace(points, candidate.place, size).coverage() > least_coverage;
}
} // namespace

bool isViewpoint(const Points& points, const Eigen::Vector3f& place, float size, int threads)
{
  const Points few = everyNth(points, most_points);
  const HiddenPoints hidden(few, fine_turns);
  return isSeenFrom(few, hidden, {place, hidden.share(place)}, size, threads);
}

std::optional<Eigen::Vector3f> findViewpoint(const Points& points, float size, int threads)
{
  const Points few = everyNth(points, most_points);
  const HiddenPoints hidden(few, fine_turns);
  std::vector<RatedPlace> found;
  for (const RatedPlace& start : coarseSearch(points, threads))
    found.push_back(descend(hidden, {start.place, hidden.share(start.place)}, size, threads));
  const RatedPlace best = *std::min_element(found.begin(), found.end());
  if (!isSeenFrom(few, hidden, best, size, threads))
    return {};
  return best.place;
}
} // namespace fresco::registration
