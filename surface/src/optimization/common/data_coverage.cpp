// SPDX-License-Identifier: BSD-3-Clause
#include "optimization/common/data_coverage.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/statistics.h>
#include <limits>
namespace fresco::optimization {
namespace {
constexpr double none = std::numeric_limits<double>::infinity();

using Eigen::Vector3d;

// Nearer datum for v, of `datum` and `best`; the smaller index where both are equally far.
void improve(const DataPoints& data, const Vector3d& v, int datum, int& best, double& squared)
{
  if (datum < 0 || datum == best)
    return;
  const double own = (data.points.col(datum).cast<double>() - v).squaredNorm();
  if (own < squared || (own == squared && datum < best)) {
    squared = own;
    best = datum;
  }
}

// The nearest datum of each vertex, along the mesh; -1 = none.
std::vector<int> nearestData(const MeshGraph& graph, const Positions& x, const DataPoints& data,
                             const FacePoints& lists, int threads)
{
  std::vector<int> nearest(graph.vertexCount(), -1), next(nearest.size());
  parallelFor(graph.vertexCount(), threads, [&](Index v) {
    double squared = none;
    for (const int f : facesAround(graph, v))
      for (int j = lists.begin[f]; j < lists.begin[f + 1]; ++j)
        improve(data, x.col(v), lists.order[j], nearest[v], squared);
  });
  for (int ring = 0; ring < most_rings; ++ring) {
    const Index changes = parallelSum(graph.vertexCount(), threads, Index{0}, [&](Index v) -> Index {
      int best = nearest[v];
      double squared = best < 0 ? none : (data.points.col(best).cast<double>() - x.col(v)).squaredNorm();
      for (const int e : edgesAround(graph, v))
        improve(data, x.col(v), nearest[graph.otherVertex(e, v)], best, squared);
      next[v] = best;
      return best != nearest[v] ? 1 : 0;
    });
    nearest.swap(next);
    if (changes == 0)
      break;
  }
  return nearest;
}

// Distance of each datum that is nearest to a vertex to its second nearest neighbour among these: one close companion
// says nothing of the others.
std::vector<double> spacingOf(const MeshGraph& graph, const DataPoints& data, const std::vector<int>& nearest)
{
  std::vector<double> first(data.size(), none), second(data.size(), none);
  std::vector<int> companion(data.size(), -1);
  const auto tell = [&](int datum, int other, double distance) {
    if (companion[datum] == other)
      return;
    if (distance < first[datum]) {
      second[datum] = first[datum];
      first[datum] = distance;
      companion[datum] = other;
    } else if (distance < second[datum]) {
      second[datum] = distance;
    }
  };
  for (const auto& [a, b] : graph.edges) {
    const int s = nearest[a], t = nearest[b];
    if (s < 0 || t < 0 || s == t)
      continue;
    const double distance = (data.points.col(s) - data.points.col(t)).cast<double>().norm();
    tell(s, t, distance);
    tell(t, s, distance);
  }
  for (std::size_t s = 0; s < first.size(); ++s)
    if (second[s] == none)
      second[s] = first[s] == none ? 0.0 : first[s];
  return second;
}

struct NearDatum {
  int datum;
  double share, distance;
};

// The data nearest to v and to the vertices around it, with shares that fall to nothing where one is farther than the
// nearest by `width`.
void findNear(const MeshGraph& graph, const Positions& x, const DataPoints& data, const std::vector<int>& nearest,
              Index v, std::vector<NearDatum>& near)
{
  constexpr double width = 0.25; // mean edge lengths
  near.clear();
  double least = none, sum = 0.0;
  const auto add = [&](int datum) {
    if (datum < 0 || std::any_of(near.begin(), near.end(), [&](const NearDatum& n) { return n.datum == datum; }))
      return;
    near.push_back({datum, 0.0, (data.points.col(datum).cast<double>() - x.col(v)).norm()});
    least = std::min(least, near.back().distance);
  };
  add(nearest[v]);
  for (const int e : edgesAround(graph, v))
    add(nearest[graph.otherVertex(e, v)]);
  for (NearDatum& n : near)
    sum += n.share = ramp(n.distance, least + width, least);
  for (NearDatum& n : near)
    n.share /= sum;
}

// The area of vertices goes to the data on the faces around them by their barycentric coordinates, that of vertices
// without such data to the nearest.
class Covering {
public:
  Covering(const MeshGraph& graph, const Positions& x, const DataPoints& data, const FacePoints& lists, int threads)
      : graph_(graph), x_(x), data_(data), lists_(lists), threads_(threads)
  {}

  DataCoverage run()
  {
    coverage_.vertex.assign(graph_.vertexCount(), 0);
    coverage_.nearness.setZero(graph_.vertexCount());
    coverage_.rate.resize(graph_.vertexCount());
    coverage_.point_weight.setZero(data_.size());
    feet_.resize(3, lists_.order.size());
    parallelFor(graph_.faceCount(), threads_, [&](Index f) {
      for (int j = lists_.begin[f]; j < lists_.begin[f + 1]; ++j)
        feet_.col(j) = footOn(graph_, x_, f, data_.points.col(lists_.order[j]).cast<double>());
    });
    const Eigen::VectorXd around = countAround();
    const Eigen::RowVectorXd areas = areaVectors(graph_, x_, threads_).colwise().norm() / 6.0; // of a face, per corner
    coverage_.nearest = nearestData(graph_, x_, data_, lists_, threads_);
    const std::vector<double> spacing = spacingOf(graph_, data_, coverage_.nearest);
    findNearness(spacing);
    for (Index v = 0; v < graph_.vertexCount(); ++v) {
      constexpr double enough = 0.5; // of a datum: takes the whole area
      const double own = ramp(around[v], 0.0, enough);
      double area = 0.0;
      for (const int f : facesAround(graph_, v))
        area += areas[f];
      coverage_.rate[v] = area / std::max(around[v], enough);
      if (own < 1.0)
        giveToNearest(v, (1.0 - own) * area, spacing);
    }
    for (Index f = 0; f < graph_.faceCount(); ++f)
      for (int j = lists_.begin[f]; j < lists_.begin[f + 1]; ++j)
        for (int k = 0; k < 3; ++k)
          coverage_.point_weight[lists_.order[j]] +=
              static_cast<float>(lists_.share[j] * feet_(k, j) * coverage_.rate[graph_.faces(k, f)]);
    return std::move(coverage_);
  }

private:
  // Data on the faces around each vertex, by their barycentric coordinates.
  Eigen::VectorXd countAround() const
  {
    Eigen::VectorXd around = Eigen::VectorXd::Zero(graph_.vertexCount());
    for (Index f = 0; f < graph_.faceCount(); ++f)
      for (int j = lists_.begin[f]; j < lists_.begin[f + 1]; ++j)
        for (int k = 0; k < 3; ++k)
          around[graph_.faces(k, f)] += lists_.share[j] * feet_(k, j);
    return around;
  }

  // The share of a near datum that counts.
  static double partOf(const NearDatum& n, const std::vector<double>& spacing)
  {
    // Lengths of an edge, or of the distance between neighbouring data where that is longer: two and a half pass over
    // one missing datum, but not over two.
    constexpr double reach_lengths = 2.5, near_lengths = 2.25;
    const double unit = std::max(1.0, spacing[n.datum]);
    return n.share * ramp(n.distance, reach_lengths * unit, near_lengths * unit);
  }

  void findNearness(const std::vector<double>& spacing)
  {
    parallelRanges(graph_.vertexCount(), threads_, [&](Index begin, Index end) {
      std::vector<NearDatum> near;
      for (Index v = begin; v < end; ++v) {
        findNear(graph_, x_, data_, coverage_.nearest, v, near);
        double nearness = 0.0;
        for (const NearDatum& n : near)
          nearness += partOf(n, spacing);
        coverage_.nearness[v] = static_cast<float>(nearness);
        coverage_.vertex[v] = nearness > 0.0 ? 1 : 0;
      }
    });
  }

  void giveToNearest(Index v, double area, const std::vector<double>& spacing)
  {
    findNear(graph_, x_, data_, coverage_.nearest, v, near_);
    for (const NearDatum& n : near_)
      coverage_.point_weight[n.datum] += static_cast<float>(partOf(n, spacing) * area);
  }

  const MeshGraph& graph_;
  const Positions& x_;
  const DataPoints& data_;
  const FacePoints& lists_;
  int threads_;
  DataCoverage coverage_;
  Eigen::Matrix3Xd feet_; // barycentric, by entry of the lists
  std::vector<NearDatum> near_;
};
} // namespace

DataCoverage findCoverage(const MeshGraph& graph, const Positions& x, const DataPoints& data, const FacePoints& lists,
                          int threads)
{
  DataCoverage coverage = Covering(graph, x, data, lists, threads).run();
  std::vector<float> spacings;
  for (const float weight : coverage.point_weight)
    if (weight > 0.f)
      spacings.push_back(std::sqrt(weight));
  if (!spacings.empty())
    coverage.spacing = median(spacings);
  return coverage;
}
} // namespace fresco::optimization
