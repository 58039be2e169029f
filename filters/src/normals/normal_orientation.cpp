// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/filters/core/local_sampling.h>
#include <fresco/filters/core/normal_orientation.h>
#include <numeric>
namespace fresco {
namespace {
/// Disjoint sets (union by size, so that paths stay short) of elements that also have a sign against the root
/// of their set.
class ParityUnionFind {
public:
  explicit ParityUnionFind(Index n) : parent_(n), size_(n, 1), turned_(n)
  {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  Index root(Index i) const
  {
    while (parent_[i] != i)
      i = parent_[i];
    return i;
  }
  int sign(Index i) const
  {
    bool turned = false;
    for (; parent_[i] != i; i = parent_[i])
      turned ^= turned_[i] != 0;
    return turned ? -1 : 1;
  }
  /// Joins the sets of i and j, in which the signs of i and j then are the same or opposite.
  void join(Index i, Index j, bool same)
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

private:
  std::vector<int> parent_, size_;
  std::vector<char> turned_; ///< against the parent
};

/// The points with normals, in the order of a tree.
struct Field {
  std::vector<int> columns;
  Points points; ///< projected to the plane through the mean of their neighbours: without noise across the surface
  Points normals;
  NeighborLists lists;
  Eigen::VectorXf areas;
};

Field makeField(const Points& points, const Points& normals, int threads)
{
  constexpr int neighbors = 11; // of the graph, the point included
  Points counted = points;
  for (Index i = 0; i < points.cols(); ++i)
    if (!normals.col(i).allFinite())
      counted.col(i).setConstant(NAN); // which the tree leaves out
  const PointTree tree(counted, threads);
  Field field{tree.columns(), Points(3, tree.size()), Points(3, tree.size()), {}, {}};
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

struct Agreement {
  bool same;  ///< whether the normals point to the same side
  float cost; ///< 0 = certain .. 3
};

Agreement compare(const Field& field, Index i, Index j)
{
  const Eigen::Vector3f a = field.normals.col(i), b = field.normals.col(j);
  const Eigen::Vector3f between = (field.points.col(j) - field.points.col(i)).stableNormalized();
  const float slope_a = between.dot(a), slope_b = between.dot(b);
  const float agreement = a.dot(b - 2 * slope_b * between);
  // Points that lie above each other are noise or two sides of a sheet: such edges come last.
  return {agreement >= 0, 1 - std::min(1.f, std::abs(agreement)) + slope_a * slope_a + slope_b * slope_b};
}

/// Entries of all lists sorted by the cost of their edge, equal ones in their order.
std::vector<std::int64_t> entriesByCost(const Field& field, int threads)
{
  constexpr int levels = 4096; // of the cost of an edge
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
  for (std::size_t e = 0; e < costs.size(); ++e)
    order[first[costs[e]]++] = e;
  return order;
}

/// Kruskal's algorithm; the sign of a point against the root of its part is kept along.
ParityUnionFind spanningForest(const Field& field, int threads)
{
  ParityUnionFind parts(field.points.cols());
  const Index each =
      std::max<Index>(1, field.lists.size() > 0 ? field.lists.count(0) : 1); // all lists are equally long
  for (const auto entry : entriesByCost(field, threads)) {
    const Index i = entry / each, j = field.lists.index[entry];
    if (parts.root(i) != parts.root(j))
      parts.join(i, j, compare(field, i, j).same);
  }
  return parts;
}

/// Turns that make the volume of each part positive (its flux; about the part's own mean, so that position does not
/// matter), or, of parts that enclose none, the largest component of the mean normal.
std::vector<char> partTurns(const Field& field, const ParityUnionFind& parts)
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
} // namespace

void orientToViewpoints(const Points& points, const Points& viewpoints, Points& normals, int threads)
{
  require(points.cols() == normals.cols(), "normals: ", points.cols(), " points, ", normals.cols(), " normals");
  require(viewpoints.cols() == 1 || viewpoints.cols() == points.cols(), "normals: ", viewpoints.cols(),
          " viewpoints for ", points.cols(), " points");
  parallelFor(points.cols(), threads, [&](Index i) {
    if (normals.col(i).dot(viewpoints.col(viewpoints.cols() == 1 ? 0 : i) - points.col(i)) < 0)
      normals.col(i) *= -1;
  });
}

void orientByNeighbors(const Points& points, Points& normals, int threads)
{
  require(points.cols() == normals.cols(), "normals: ", points.cols(), " points, ", normals.cols(), " normals");
  const Field field = makeField(points, normals, threads);
  const ParityUnionFind parts = spanningForest(field, threads);
  const std::vector<char> turns = partTurns(field, parts);
  for (Index i = 0; i < field.points.cols(); ++i)
    if ((parts.sign(i) < 0) != (turns[parts.root(i)] != 0))
      normals.col(field.columns[i]) *= -1;
}
} // namespace fresco
