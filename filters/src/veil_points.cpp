// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <fresco/common/parallel.h>
#include <fresco/common/require.h>
#include <fresco/filters/core/neighbors.h>
#include <fresco/filters/core/veil_points.h>
namespace fresco {
namespace {
constexpr Index fewest = 12;    // points of a viewpoint that can be judged
constexpr float deviations = 4; // of the difference of two ranges, that noise does not reach

/// What one viewpoint sees, in the order of a tree over directions.
struct Scan {
  std::vector<Index> columns;
  Points directions;
  Eigen::VectorXf ranges;
  NeighborLists lists;
};

Scan makeScan(const Points& points, const Eigen::Vector3f& viewpoint, const std::vector<Index>& columns,
              const VeilOptions& options)
{
  const auto n = static_cast<Index>(columns.size());
  Points directions(3, n);
  parallelFor(n, options.threads, [&](Index i) {
    const Eigen::Vector3f beam = points.col(columns[i]) - viewpoint;
    directions.col(i) = beam / beam.norm(); // NaN at the viewpoint: left out by the tree
  });
  const PointTree tree(directions, options.threads);
  Scan scan{{}, tree.points(), Eigen::VectorXf(tree.size()), nearestLists(tree, options.k + 1, options.threads)};
  for (Index i = 0; i < tree.size(); ++i) {
    scan.columns.push_back(columns[tree.columns()[i]]);
    scan.ranges[i] = (points.col(scan.columns.back()) - viewpoint).norm();
  }
  return scan;
}

/// The value below which `share` of the values lie; not empty.
float quantile(std::vector<float>& values, double share)
{
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Deviation of the ranges: from the differences to the medians of neighbouring ranges, of which depth jumps spoil few.
/// Half of them lie within 0.6745 deviations. Scanners that round their ranges make that zero; the third quarter, half
/// of its value to be safe from slopes, tells then.
float rangeNoise(const Scan& scan, int threads)
{
  std::vector<float> differences(scan.columns.size());
  parallelFor(scan.ranges.size(), threads, [&](Index i) {
    thread_local std::vector<float> around;
    around.clear();
    for (const int* j = scan.lists.first(i); j != scan.lists.last(i); ++j)
      around.push_back(scan.ranges[*j]);
    differences[i] = std::abs(scan.ranges[i] - quantile(around, 0.5));
  });
  const float middle = quantile(differences, 0.5) / 0.6745f;
  return std::max(middle, 0.5f * quantile(differences, 0.75) / 1.15f);
}

/// Limits that a scan is judged with.
struct Limits {
  float slope;     ///< range per way sideways that a surface can have
  float tolerance; ///< difference of ranges that noise explains, length
  float facing;    ///< sine of the angle between a beam and a plane that can be told from the veil itself
};

/// Whether point i has points in front of it and behind it, and few that a surface joins it with.
bool standsApart(const Scan& scan, Index i, const Limits& limits)
{
  int front = 0, joined = 0, behind = 0;
  const float range = scan.ranges[i];
  for (const int* j = scan.lists.first(i); j != scan.lists.last(i); ++j) {
    if (*j == i)
      continue;
    const float sideways = (scan.directions.col(*j) - scan.directions.col(i)).norm() * std::min(range, scan.ranges[*j]);
    const float ahead = scan.ranges[*j] - range;
    if (std::abs(ahead) <= std::max(sideways * limits.slope, limits.tolerance))
      ++joined;
    else
      ++(ahead < 0 ? front : behind);
  }
  return front > 0 && behind > 0 && joined * 4 <= front + joined + behind;
}

/// Whether a plane through point i holds half of its neighbours: then it lies on a surface seen at a grazing angle. The
/// veil along a straight edge is such a plane too, but one that nearly holds the beam: nine tenths are asked for there.
/// A plane that holds the beam may be that of a scan line and tells nothing.
bool liesOnPlane(const Scan& scan, Index i, const Limits& limits)
{
  thread_local std::vector<Eigen::Vector3f> offsets;
  offsets.clear();
  const Eigen::Vector3f beam = scan.directions.col(i);
  for (const int* j = scan.lists.first(i); j != scan.lists.last(i); ++j)
    if (*j != i)
      offsets.push_back(scan.ranges[*j] * scan.directions.col(*j) - scan.ranges[i] * beam);
  for (std::size_t a = 0; a < offsets.size(); ++a)
    for (std::size_t b = a + 1; b < offsets.size(); ++b) {
      const Eigen::Vector3f cross = offsets[a].cross(offsets[b]);
      const float length = cross.norm();
      if (length < 0.1f * offsets[a].norm() * offsets[b].norm())
        continue;
      const float facing = std::abs(cross.dot(beam)) / length;
      if (facing < 0.5f * limits.facing)
        continue;
      const float share = facing < limits.facing ? 0.9f : 0.5f;
      const auto near = std::count_if(offsets.begin(), offsets.end(), [&](const Eigen::Vector3f& offset) {
        return std::abs(cross.dot(offset)) <= 0.75f * limits.tolerance * length;
      });
      if (static_cast<float>(near) >= share * static_cast<float>(offsets.size()))
        return true;
    }
  return false;
}

void judge(const Scan& scan, const VeilOptions& options, std::vector<char>& veil)
{
  if (static_cast<Index>(scan.columns.size()) <= fewest)
    return;
  const float noise = options.noise > 0 ? options.noise : rangeNoise(scan, options.threads);
  const float angle = options.angle * 0.017453293f;
  const Limits limits{1 / std::tan(angle), deviations * noise, std::sin(0.6f * angle)};
  parallelFor(scan.ranges.size(), options.threads,
              [&](Index i) { veil[scan.columns[i]] = standsApart(scan, i, limits) && !liesOnPlane(scan, i, limits); });
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
  require(options.k >= 4, "veil points: k ", options.k, " is below 4");
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
