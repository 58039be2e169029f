// SPDX-License-Identifier: BSD-3-Clause
#include "stages/fusion.h"
#include "stages/placed_points.h"
#include <fresco/core/require.h>
namespace fresco::model {
PointFusion::PointFusion(double cell) : cell_(cell) { require(cell > 0, "fusion: cell ", cell, " is not positive"); }

PointFusion::Sum& PointFusion::at(const Eigen::Vector3f& point, const Eigen::Vector3f& normal)
{
  constexpr std::int64_t half = std::int64_t{1} << 19;
  std::uint64_t key = 0;
  for (int k = 0; k < 3; ++k) {
    const auto index = static_cast<std::int64_t>(std::floor(point[k] / cell_)) + half;
    require(index >= 0 && index < 2 * half, "fusion: a point lies more than ", half, " cells from the origin");
    key = key << 20 | static_cast<std::uint64_t>(index);
  }
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  key = key << 3 | static_cast<std::uint64_t>(2 * axis + (normal[axis] < 0.f));
  const auto [found, fresh] = cells_.try_emplace(key, sums_.size());
  if (fresh)
    sums_.emplace_back();
  return sums_[found->second];
}

void PointFusion::add(const PointSet& set)
{
  validatePointSet(set);
  require(set.hasNormals(), "fusion: the points have no normals");
  for (Index i = 0; i < set.size(); ++i) {
    const double weight = set.confidences.size() > 0 ? set.confidences[i] : 1.0;
    if (!set.points.col(i).allFinite() || !set.normals.col(i).allFinite() || !(weight > 0))
      continue;
    Sum& sum = at(set.points.col(i), set.normals.col(i));
    sum.weight += weight;
    sum.point += weight * set.points.col(i).cast<double>();
    sum.normal += weight * set.normals.col(i).cast<double>();
  }
}

PointSet PointFusion::result() const
{
  std::vector<const Sum*> kept;
  for (const Sum& sum : sums_)
    if (sum.normal.norm() > 0)
      kept.push_back(&sum);
  const Index count = kept.size();
  PointSet set;
  set.points.resize(3, count);
  set.normals.resize(3, count);
  set.confidences.resize(count);
  for (Index i = 0; i < count; ++i) {
    const Sum& sum = *kept[i];
    set.points.col(i) = (sum.point / sum.weight).cast<float>();
    set.normals.col(i) = sum.normal.normalized().cast<float>();
    set.confidences[i] = sum.weight;
  }
  return set;
}

PointSet pointsForVertices(const PointStream& points, Index vertices, double cell)
{
  constexpr Index most_per_vertex = 16; // more cost memory and time in every iteration and say little that is new
  PointSet result;
  if (countPoints(points) <= most_per_vertex * vertices) {
    points.read([&](const PointSet& window) { appendPoints(result, window); });
    result.colors.resize(3, 0);
    return result;
  }
  PointFusion fusion(cell / 3);
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  points.read([&](const PointSet& window) {
    origin = window.origin;
    fusion.add(window);
  });
  result = fusion.result();
  result.origin = origin;
  return result;
}
} // namespace fresco::model
