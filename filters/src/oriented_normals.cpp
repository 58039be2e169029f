// SPDX-License-Identifier: BSD-3-Clause
#include "edge_fit.h"
#include "near_groups.h"
#include "view_direction.h"
#include <algorithm>
#include <cmath>
#include <fresco/common/parallel.h>
#include <fresco/common/require.h>
#include <fresco/filters/core/normal_orientation.h>
#include <fresco/filters/core/oriented_normals.h>
#include <numeric>
namespace fresco {
namespace {
constexpr int fewest = 6;                  // neighbours within a radius; below, the nearest are taken
constexpr int most = 256;                  // neighbours within a radius; beyond, evenly chosen
constexpr Index group_leaves = 8;          // searched for at once
constexpr std::size_t most_leaves = 65536; // around them; beyond, each point is searched for alone
constexpr Index spread = 2;        // times the neighbours of a point are kept in dense parts to choose them from
constexpr float least_width = 6.f; // radius of a neighbourhood / deviation of the points from the surface

void validate(const PointSet& set, const NormalOptions& options)
{
  validatePointSet(set);
  require(options.k >= 3, "normals: k ", options.k, " is below 3");
  require(options.radius >= 0 && std::isfinite(options.radius), "normals: radius ", options.radius,
          " is negative or not finite");
  require(options.image_width == 0 || (options.image_width > 0 && set.size() % options.image_width == 0),
          "normals: no image of width ", options.image_width, " has ", set.size(), " points");
  require(set.viewpoints.cols() != 1 || set.viewpoints.allFinite(), "normals: the viewpoint is not finite");
}

NeighborLists listsWithin(const PointTree& tree, const NormalOptions& options)
{
  const NeighborLists nearest = nearestLists(tree, fewest, options.threads);
  Eigen::VectorXf radii = Eigen::VectorXf::Constant(tree.size(), options.radius);
  parallelFor(tree.size(), options.threads, [&](Index i) {
    const float last = (tree.point(*(nearest.last(i) - 1)) - tree.point(i)).norm() * (1 + 1e-5f);
    radii[i] = std::max(radii[i], std::isfinite(last) ? last : 0.f);
  });
  return radiusLists(tree, radii, most, options.threads);
}

/// Deviation of the points from their surfaces: the median of every 16th plane fit to `lists`.
float surfaceNoise(const PointTree& tree, const NeighborLists& lists, int threads)
{
  std::vector<float> deviations(static_cast<std::size_t>((tree.size() + 15) / 16));
  parallelFor(static_cast<Index>(deviations.size()), threads, [&](Index s) {
    Moments moments;
    for (const int* j = lists.first(16 * s); j != lists.last(16 * s); ++j)
      moments.add(tree.point(*j) - tree.point(16 * s));
    const auto count = static_cast<float>(lists.count(16 * s));
    deviations[s] = std::sqrt(fitPlane(moments).variance * count / std::max(1.f, count - 3));
  });
  const auto middle = deviations.begin() + static_cast<std::ptrdiff_t>(deviations.size() / 2);
  std::nth_element(deviations.begin(), middle, deviations.end());
  return deviations.empty() ? 0.f : *middle;
}

/// Writes as many points as list i has, spread evenly, from as far as `radius`.
void widenList(const PointTree& tree, float radius, NearGroup& group, NeighborLists& lists, Index i)
{
  thread_local std::vector<PointTree::Key> keys;
  int* list = lists.index.data() + lists.begin[i];
  const auto count = static_cast<std::size_t>(lists.count(i));
  const std::size_t found = group.within(i, radius);
  const bool enough = found >= count;
  if (!enough)
    tree.withinKeys(tree.point(i), radius, keys, false);
  const double step = static_cast<double>(enough ? found : keys.size()) / static_cast<double>(count);
  for (std::size_t j = 0; step >= 1 && j < count; ++j) {
    const auto at = static_cast<std::size_t>((static_cast<double>(j) + 0.5) * step);
    list[j] = enough ? group.positions()[at] : PointTree::position(keys[at]);
  }
}

/// Neighbourhoods that noise makes as thick as wide have no normal: where the scan is so dense, the same number of
/// neighbours is taken, spread evenly, from as far as `radius`.
void widenLists(const PointTree& tree, float radius, NeighborLists& lists, int threads)
{
  const auto narrow = [&](Index i) { return (tree.point(*(lists.last(i) - 1)) - tree.point(i)).norm() < radius; };
  const std::vector<Index> groups = tree.subtrees(group_leaves);
  parallelRanges(static_cast<Index>(groups.size()) - 1, threads, [&](Index begin, Index end) {
    NearGroup group(tree);
    for (Index g = begin; g < end; ++g) {
      group.enter(groups[g], groups[g + 1]);
      std::vector<Index> members;
      for (Index i = group.begin(); i < group.end(); ++i)
        if (narrow(i))
          members.push_back(i);
      if (members.empty())
        continue;
      group.gather(radius, most_leaves);
      const auto wanted = static_cast<std::size_t>(spread * lists.count(members.front()));
      const std::size_t found = group.within(members[members.size() / 2], radius);
      if (found >= 2 * wanted)
        group.thin(found / wanted);
      for (const Index i : members)
        widenList(tree, radius, group, lists, i);
    }
  });
}

NeighborLists listsByCount(const PointTree& tree, const NormalOptions& options)
{
  NeighborLists lists = nearestLists(tree, options.k, options.threads);
  if (tree.size() > options.k)
    widenLists(tree, least_width * surfaceNoise(tree, lists, options.threads), lists, options.threads);
  return lists;
}

Neighborhoods findNeighborhoods(const PointSet& set, const NormalOptions& options)
{
  if (options.image_width > 1 && options.radius == 0) {
    std::vector<int> columns(static_cast<std::size_t>(set.size()));
    std::iota(columns.begin(), columns.end(), 0);
    return {set.points, std::move(columns), imageLists(set.points, options.image_width, options.k, options.threads)};
  }
  const PointTree tree(set.points, options.threads);
  return {tree.points(), tree.columns(), options.radius > 0 ? listsWithin(tree, options) : listsByCount(tree, options)};
}

/// Unit normal that `fit` and the direction `view` leave, oriented to `view`; NaN if they leave none.
Eigen::Vector3f normalOf(const PlaneFit& fit, const Eigen::Vector3f& view)
{
  Eigen::Vector3f normal = fit.normal;
  if (fit.shape == PlaneFit::line)
    normal = view - fit.normal.dot(view) * fit.normal;
  else if (fit.shape == PlaneFit::point)
    normal = view;
  const float length = normal.norm();
  if (!(length > 0) || !std::isfinite(length))
    return Eigen::Vector3f::Constant(NAN);
  return (normal.dot(view) < 0 ? -1 : 1) / length * normal;
}

/// Points per area of each neighbourhood, any common factor.
Eigen::VectorXf densities(const Neighborhoods& all, int threads)
{
  Eigen::VectorXf result(all.lists.size());
  parallelFor(result.size(), threads, [&](Index i) {
    float reach = 0;
    for (const int* j = all.lists.first(i); j != all.lists.last(i); ++j)
      reach = std::max(reach, (all.points.col(*j) - all.points.col(i)).squaredNorm());
    result[i] = reach > 0 ? static_cast<float>(all.lists.count(i)) / reach : 0.f;
  });
  return result;
}

/// 0..1: few neighbours, or farther ones than the neighbours themselves have, count little; so does a grazing view.
float confidenceOf(const Neighborhoods& all, const Eigen::VectorXf& density, Index i)
{
  const auto count = static_cast<float>(all.lists.count(i));
  float around = 0;
  for (const int* j = all.lists.first(i); j != all.lists.last(i); ++j)
    around += density[*j] / count;
  const float company = std::clamp((count - 2) / (fewest - 2), 0.f, 1.f);
  return around > 0 ? company * std::min(1.f, density[i] / around) : 0.f;
}

NormalField toField(const PointSet& set, const Neighborhoods& all, const std::vector<PlaneFit>& fits, int threads)
{
  NormalField field;
  field.normals = Points::Constant(3, set.size(), NAN);
  field.curvatures = Eigen::VectorXf::Constant(set.size(), NAN);
  field.confidences = Eigen::VectorXf::Zero(set.size());
  const Eigen::VectorXf density = densities(all, threads);
  parallelFor(all.lists.size(), threads, [&](Index i) {
    const Index column = all.columns[i];
    if (all.lists.count(i) == 0)
      return;
    const Eigen::Vector3f view = viewDirection(set, column), normal = normalOf(fits[i], view);
    field.normals.col(column) = normal;
    field.curvatures[column] = fits[i].curvature;
    if (fits[i].shape == PlaneFit::plane) {
      const float length = view.norm();
      const float incidence = length > 0 ? std::abs(normal.dot(view)) / length : 1.f;
      field.confidences[column] = confidenceOf(all, density, i) * incidence;
    }
  });
  return field;
}
} // namespace

NormalField estimateNormals(const PointSet& set, const NormalOptions& options, const Progress& progress)
{
  validate(set, options);
  report(progress, "find neighbours", 0.0);
  const Neighborhoods all = findNeighborhoods(set, options);
  report(progress, "fit planes", 0.6);
  std::vector<PlaneFit> fits = fitLists(all, options.threads);
  if (options.edges)
    refitAtEdges(set, all, fits, options.threads);
  report(progress, "orient normals", 0.9);
  NormalField field = toField(set, all, fits, options.threads);
  if (set.viewpoints.cols() == 0)
    orientByNeighbors(set.points, field.normals, options.threads);
  return field;
}
} // namespace fresco
