// SPDX-License-Identifier: BSD-3-Clause
#include "normals/orientation_forest.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/filters/core/local_sampling.h>
#include <numeric>
namespace fresco::filters {
ParityUnionFind::ParityUnionFind(Index n) : parent_(n), size_(n, 1), turned_(n)
{
  std::iota(parent_.begin(), parent_.end(), 0);
}

void ParityUnionFind::join(Index i, Index j, bool same)
{
  const bool turned = (sign(i) == sign(j)) != same;
  Index a = root(i), b = root(j);
  if (a == b)
    return;
  if (size_[a] < size_[b])
    std::swap(a, b);
  parent_[b] = a;
  size_[a] += size_[b];
  turned_[b] = turned;
}

NormalGraph makeNormalGraph(const Points& points, const Points& normals, int threads)
{
  constexpr int neighbors = 11; // of the graph, the point included
  Points counted = points;
  for (Index i = 0; i < points.cols(); ++i)
    if (!normals.col(i).allFinite())
      counted.col(i).setConstant(NAN); // which the tree leaves out
  const PointTree tree(counted, threads);
  NormalGraph field{tree.columns(), Points(3, tree.size()), Points(3, tree.size()), {}, {}};
  field.lists = nearestLists(tree, neighbors, threads);
  field.areas = sampleAreas(tree, field.lists, threads);
  parallelFor(tree.size(), threads, [&](Index i) {
    field.normals.col(i) = normals.col(field.columns[i]);
    const Eigen::Vector3f point = tree.point(i), normal = field.normals.col(i);
    float height = 0;
    for (const int* j = field.lists.first(i); j != field.lists.last(i); ++j)
      height += normal.dot(tree.point(*j) - point) / field.lists.count(i);
    field.points.col(i) = point + (std::isfinite(height) ? height : 0.f) * normal;
  });
  return field;
}

namespace {
struct Agreement {
  bool same;  ///< whether the normals point to the same side
  float cost; ///< 0 = certain .. 3
};

Agreement compare(const NormalGraph& field, Index i, Index j)
{
  const Eigen::Vector3f a = field.normals.col(i), b = field.normals.col(j);
  const Eigen::Vector3f between = (field.points.col(j) - field.points.col(i)).stableNormalized();
  const float slope_a = between.dot(a), slope_b = between.dot(b);
  const float agreement = a.dot(b - 2 * slope_b * between);
  // Points that lie above each other are noise or two sides of a sheet: such edges come last.
  return {agreement >= 0, 1 - std::min(1.f, std::abs(agreement)) + slope_a * slope_a + slope_b * slope_b};
}

constexpr int levels = 4096;               ///< of the cost of an edge
constexpr int certain_level = levels / 20; ///< 0.15 of 3: normals and both slopes together off by 20 degrees

struct Entries {
  std::vector<std::int64_t> order; ///< of all lists sorted by the cost of their edge, equal ones in their order
  std::int64_t certain;            ///< how many of these tell all but certainly
};

Entries entriesByCost(const NormalGraph& field, int threads)
{
  std::vector<std::uint16_t> costs(field.lists.index.size());
  parallelFor(field.lists.size(), threads, [&](Index i) {
    for (auto e = field.lists.begin[i]; e < field.lists.begin[i + 1]; ++e) {
      const float cost = compare(field, i, field.lists.index[e]).cost * (levels - 1) / 3;
      costs[e] = std::clamp<float>(cost, 0, levels - 1);
    }
  });
  std::vector<std::int64_t> first(levels + 1, 0), order(costs.size());
  for (const auto cost : costs)
    ++first[cost + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  const std::int64_t certain = first[certain_level];
  for (std::size_t e = 0; e < costs.size(); ++e)
    order[first[costs[e]]++] = e;
  return {order, certain};
}
} // namespace

OrientationForest spanningForest(const NormalGraph& field, int threads)
{
  const Index count = field.points.cols();
  OrientationForest forest{ParityUnionFind(count), std::vector<int>(count)};
  const Index each =
      std::max<Index>(1, field.lists.size() > 0 ? field.lists.count(0) : 1); // all lists are equally long
  const Entries entries = entriesByCost(field, threads);
  const auto joinFrom = [&](std::int64_t begin, std::int64_t end) { // Kruskal's algorithm
    for (std::int64_t e = begin; e < end; ++e) {
      const Index i = entries.order[e] / each, j = field.lists.index[entries.order[e]];
      if (forest.parts.root(i) != forest.parts.root(j))
        forest.parts.join(i, j, compare(field, i, j).same);
    }
  };
  joinFrom(0, entries.certain);
  for (Index i = 0; i < count; ++i)
    forest.patches[i] = forest.parts.root(i);
  joinFrom(entries.certain, entries.order.size());
  return forest;
}

std::vector<char> partTurns(const NormalGraph& field, const ParityUnionFind& parts)
{
  struct Part {
    double area = 0, flux = 0, size = 0;
    Eigen::Vector3d moment = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
  };
  const Index n = field.points.cols();
  std::vector<Part> sums(n);
  for (Index i = 0; i < n; ++i) {
    Part& part = sums[parts.root(i)];
    part.area += field.areas[i];
    part.moment += static_cast<double>(field.areas[i]) * field.points.col(i).cast<double>();
  }
  for (Index i = 0; i < n; ++i) {
    Part& part = sums[parts.root(i)];
    const Eigen::Vector3d arm = field.points.col(i).cast<double>() - part.moment / part.area;
    const Eigen::Vector3d normal = parts.sign(i) * field.normals.col(i).cast<double>();
    part.flux += field.areas[i] * normal.dot(arm);
    part.size += field.areas[i] * arm.norm();
    part.normal += field.areas[i] * normal;
  }
  std::vector<char> turns(n);
  for (Index i = 0; i < n; ++i) {
    const Part& part = sums[i];
    Index largest;
    part.normal.cwiseAbs().maxCoeff(&largest);
    turns[i] = std::abs(part.flux) > 0.01 * part.size ? part.flux < 0 : part.normal[largest] < 0;
  }
  return turns;
}
} // namespace fresco::filters
