// SPDX-License-Identifier: BSD-3-Clause
#include "beam_window.h"
#include "near_groups.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <fresco/common/parallel.h>
#include <fresco/common/require.h>
#include <fresco/filters/core/veil_points.h>
#include <limits>
namespace fresco {
namespace {
constexpr Index fewest = 12;    // points of a viewpoint that can be judged
constexpr float deviations = 4; // that noise does not reach
/// Radians between beams that see jumps apart: about the width of a laser beam at common ranges.
constexpr float least_spacing = 0.003f;
constexpr Index spacing_samples = 1024;

/// Median distance between neighbouring beams, radians.
float beamSpacing(const PointTree& directions)
{
  constexpr int around = 8;
  std::vector<float> squared;
  std::vector<Neighbor> found;
  const Index count = std::min(spacing_samples, directions.size());
  for (Index s = 0; s < count; ++s) {
    directions.nearest(directions.point(s * directions.size() / count), around + 1, found);
    squared.push_back(found.back().squared_distance);
  }
  const auto middle = squared.begin() + count / 2;
  std::nth_element(squared.begin(), middle, squared.end());
  return count > 0 ? std::sqrt(*middle * 3.1416f / around) : 0.f;
}

/// As nearestLists() of every m-th beam, without those closer than half of least_spacing; the beam itself comes first.
NeighborLists thinnedLists(const PointTree& directions, Index m, const VeilOptions& options)
{
  Points some(3, (directions.size() + m - 1) / m);
  for (Index i = 0; i < some.cols(); ++i)
    some.col(i) = directions.point(m * i);
  const PointTree tree(some, options.threads);
  const auto each = static_cast<Index>(options.k) + 1;
  NeighborLists lists = evenLists(directions.size(), each);
  parallelRanges(directions.size(), options.threads, [&](Index begin, Index end) {
    std::vector<Neighbor> found;
    for (Index i = begin; i < end; ++i) {
      int* list = lists.index.data() + lists.begin[i];
      std::fill_n(list, each, static_cast<int>(i));
      Index count = 1;
      tree.nearest(directions.point(i), 2 * options.k, found);
      for (const Neighbor& beam : found)
        if (count < each && beam.squared_distance > 0.25f * least_spacing * least_spacing)
          list[count++] = static_cast<int>(m * beam.index);
    }
  });
  return lists;
}

BeamScan makeScan(const Points& points, const Eigen::Vector3f& viewpoint, const std::vector<Index>& columns,
                  const VeilOptions& options)
{
  const auto n = static_cast<Index>(columns.size());
  Points directions(3, n);
  parallelFor(n, options.threads, [&](Index i) {
    const Eigen::Vector3f beam = points.col(columns[i]) - viewpoint;
    directions.col(i) = beam / beam.norm(); // NaN at the viewpoint: left out by the tree
  });
  auto tree = std::make_unique<PointTree>(directions, options.threads);
  const float times = least_spacing / beamSpacing(*tree);
  const Index m = times * times < static_cast<float>(tree->size()) ? static_cast<Index>(times * times) : 1;
  BeamScan scan{{}, tree->points(), Eigen::VectorXf(tree->size()), {}, nullptr, 0};
  scan.lists = m > 1 ? thinnedLists(*tree, m, options) : nearestLists(*tree, options.k + 1, options.threads);
  for (Index i = 0; i < tree->size(); ++i) {
    scan.columns.push_back(columns[tree->columns()[i]]);
    scan.ranges[i] = (points.col(scan.columns.back()) - viewpoint).norm();
  }
  if (m > 1)
    scan.tree = std::move(tree);
  return scan;
}

/// How the beams around a point relate to it without regard to surfaces.
struct Surroundings {
  bool front = false, behind = false; ///< whether one of the nearest 8 is clearly nearer, farther
  bool paired = false;                ///< whether one of the nearest 8 has the same range
  float joined = 0;                   ///< share of the nearer half that a surface could join it with
  float gap = 0;                      ///< distance to the nearest neighbour / way across to the nearest beam
};

Surroundings surroundingsOf(const BeamWindow& window, float noise, float slope)
{
  Surroundings result;
  const std::size_t half = (window.beams.size() + 1) / 2;
  float nearest = std::numeric_limits<float>::infinity();
  for (std::size_t k = 0; k < window.beams.size(); ++k) {
    const float ahead = window.beams[k].range - window.range, sideways = window.beams[k].sideways;
    nearest = std::min(nearest, std::hypot(ahead, sideways));
    if (k < 8) {
      result.front |= ahead < -3 * noise;
      result.behind |= ahead > 3 * noise;
      result.paired |= std::abs(ahead) < deviations * noise;
    }
    if (k < half)
      result.joined +=
          std::abs(ahead) <= std::max(sideways * slope, deviations * noise) ? 1 / static_cast<float>(half) : 0;
  }
  result.gap = nearest / std::max(window.beams.front().sideways, std::numeric_limits<float>::min());
  return result;
}

/// Sides of a point, of 16 (half and quarter discs of neighbours in 8 directions), whose surface goes on ...
struct Sides {
  int in_front = 0;   ///< in front of the point
  int behind = 0;     ///< behind it
  bool meets = false; ///< through the point: it belongs to that surface
};

Sides sidesOf(const BeamWindow& window, float noise)
{
  Sides sides;
  for (int direction = 0; direction < 8; ++direction)
    for (const bool half : {true, false}) {
      // Halfway between neighbouring beams: no beam lies at the border of a side, and the frame of the scan does not
      // matter.
      const float bearing = window.beams.front().bearing + 0.785398f * (static_cast<float>(direction) + 0.5f);
      const auto side =
          half ? continueSide(window, bearing, 1.4f, 12, noise) : continueSide(window, bearing, 0.85f, 6, noise);
      if (!side)
        continue;
      const float off = (window.range - side->range) / side->deviation;
      sides.in_front += off > deviations;
      sides.behind += off < -deviations;
      sides.meets |= half && std::abs(off) <= deviations;
    }
  return sides;
}

/// A point that stands alone between what is in front and a surface behind, or between two surfaces that several sides
/// agree on: more of them if it has a neighbour nearby (of the veil too, or one that happens to lie as far), or if a
/// surface could join it with up to half of the beams around.
bool isVeil(const BeamWindow& window, float noise, float slope)
{
  if (window.beams.size() < 8)
    return false;
  const Surroundings around = surroundingsOf(window, noise, slope);
  const bool few_joined = around.joined <= 0.34f, far = around.gap >= 1.8f;
  if (!around.front || !around.behind || around.joined > 0.5f || around.gap < 1.1f || !(few_joined || far))
    return false;
  const Sides sides = sidesOf(window, noise);
  const bool alone = !sides.meets && sides.behind >= 1 && !around.paired && few_joined && around.gap > 2.5f;
  const bool clear = few_joined && far;
  return alone || (sides.in_front >= (clear ? 2 : 4) && sides.behind >= (clear ? 2 : 3));
}

/// Whether a surface could join the point with most of the beams next to it: of a thin thing that windows of a dense
/// scan pass over.
bool joinsNext(const BeamScan& scan, Index i, float slope)
{
  constexpr int around = 8;
  thread_local std::vector<PointTree::Key> found;
  scan.tree->nearestKeys(scan.directions.col(i), around + 1, found);
  int joined = -1; // without the point itself
  for (const PointTree::Key beam : found) {
    const float range = scan.ranges[PointTree::position(beam)], ahead = std::abs(range - scan.ranges[i]);
    const float sideways = std::sqrt(PointTree::squaredDistance(beam)) * std::min(range, scan.ranges[i]);
    joined += ahead <= std::max(sideways * slope, deviations * scan.noise);
  }
  return 2 * joined > around;
}

void judge(BeamScan scan, const VeilOptions& options, std::vector<char>& veil)
{
  if (static_cast<Index>(scan.columns.size()) <= fewest)
    return;
  scan.noise = options.noise > 0 ? options.noise : measureNoise(scan, options.threads);
  const float slope = 1 / std::tan(options.angle * 0.017453293f);
  parallelRanges(scan.ranges.size(), options.threads, [&](Index begin, Index end) {
    BeamWindow window;
    for (Index i = begin; i < end; ++i) {
      fillWindow(scan, i, window);
      veil[scan.columns[i]] = isVeil(window, scan.noise, slope) && !(scan.tree && joinsNext(scan, i, slope));
    }
  });
}

/// `columns` without repetitions of the same point; `first` gets for each column the one that stays.
std::vector<Index> withoutRepetitions(const Points& points, std::vector<Index> columns, std::vector<Index>& first)
{
  const auto key = [&](Index i) { return std::array{points(0, i), points(1, i), points(2, i)}; };
  std::sort(columns.begin(), columns.end(), [&](Index a, Index b) {
    const auto key_a = key(a), key_b = key(b);
    return key_a != key_b ? key_a < key_b : a < b;
  });
  std::vector<Index> single;
  for (const Index i : columns) {
    if (single.empty() || key(single.back()) != key(i))
      single.push_back(i);
    first[static_cast<std::size_t>(i)] = single.back();
  }
  std::sort(single.begin(), single.end());
  return single;
}

/// Finite points grouped by equal viewpoints.
std::vector<std::vector<Index>> groupByViewpoint(const Points& points, const Points& viewpoints)
{
  std::vector<Index> finite;
  for (Index i = 0; i < points.cols(); ++i)
    if (points.col(i).allFinite())
      finite.push_back(i);
  if (viewpoints.cols() == 1)
    return {finite};
  const auto key = [&](Index i) { return std::array{viewpoints(0, i), viewpoints(1, i), viewpoints(2, i)}; };
  std::stable_sort(finite.begin(), finite.end(), [&](Index a, Index b) { return key(a) < key(b); });
  std::vector<std::vector<Index>> groups;
  for (const Index i : finite) {
    if (groups.empty() || key(groups.back().back()) != key(i))
      groups.emplace_back();
    groups.back().push_back(i);
  }
  return groups;
}

void validate(const Points& points, const Points& viewpoints, const VeilOptions& options)
{
  require(viewpoints.cols() == 1 || viewpoints.cols() == points.cols(), "veil points: ", viewpoints.cols(),
          " viewpoints for ", points.cols(), " points");
  require(viewpoints.allFinite(), "veil points: a viewpoint is not finite");
  require(options.angle > 0 && options.angle < 90, "veil points: angle ", options.angle, " is not in 0..90 degrees");
  require(options.noise >= 0 && std::isfinite(options.noise), "veil points: noise ", options.noise,
          " is negative or not finite");
  require(options.k >= 8 && options.k <= 64, "veil points: k ", options.k, " is not in 8..64");
}
} // namespace

std::vector<Index> withoutVeil(const Points& points, const Points& viewpoints, const VeilOptions& options)
{
  validate(points, viewpoints, options);
  std::vector<char> veil(static_cast<std::size_t>(points.cols()), 0);
  const auto groups = groupByViewpoint(points, viewpoints);
  std::vector<Index> first(static_cast<std::size_t>(points.cols()), -1);
  for (const auto& group : groups) {
    const std::vector<Index> single = withoutRepetitions(points, group, first);
    if (!single.empty())
      judge(makeScan(points, viewpoints.col(viewpoints.cols() == 1 ? 0 : single.front()), single, options), options,
            veil);
  }
  std::vector<Index> kept;
  for (Index i = 0; i < points.cols(); ++i)
    if (first[i] >= 0 && veil[first[i]] == 0)
      kept.push_back(i);
  return kept;
}
} // namespace fresco
