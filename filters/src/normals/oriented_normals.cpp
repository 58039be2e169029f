// SPDX-License-Identifier: BSD-3-Clause
#include "normals/edge_aware_refit.h"
#include "normals/knn_planes.h"
#include "normals/view_direction.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/machine_memory.h>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/filters/core/normal_orientation.h>
#include <fresco/filters/core/oriented_normals.h>
#include <numeric>
namespace fresco {
using namespace filters;
namespace {
void validate(const PointSet& set, const NormalOptions& options)
{
  validatePointSet(set);
  require(options.k >= 3 && options.k <= Neighborhoods::most_neighbors, "normals: k ", options.k, " is not in 3..",
          Neighborhoods::most_neighbors);
  require(options.radius >= 0 && std::isfinite(options.radius), "normals: radius ", options.radius,
          " is negative or not finite");
  require(options.image_width == 0 || (options.image_width > 0 && set.size() % options.image_width == 0),
          "normals: no image of width ", options.image_width, " has ", set.size(), " points");
  require(set.viewpoints.cols() != 1 || set.viewpoints.allFinite(), "normals: the viewpoint is not finite");
}

NeighborLists listsWithin(const PointTree& tree, const NormalOptions& options)
{
  const NeighborLists nearest = nearestLists(tree, fewest_within, options.threads); // a plane with as much again
  Eigen::VectorXf radii = Eigen::VectorXf::Constant(tree.size(), options.radius);
  parallelFor(tree.size(), options.threads, [&](Index i) {
    const float last = (tree.point(*(nearest.last(i) - 1)) - tree.point(i)).norm() * (1 + 1e-5f);
    radii[i] = std::max(radii[i], std::isfinite(last) ? last : 0.f);
  });
  return radiusLists(tree, radii, most_within, options.threads);
}

/// Lists by column, in that order.
void useLists(const PointSet& set, const NeighborLists& lists, int threads, Neighborhoods& all)
{
  all.image_columns.resize(set.size());
  std::iota(all.image_columns.begin(), all.image_columns.end(), 0);
  all.image_coordinates.resize((set.size() + 7) / 8 * 24);
  for (Index i = 0; i < set.size(); ++i)
    for (Index axis = 0; axis < 3; ++axis)
      all.image_coordinates[i / 8 * 24 + 8 * axis + i % 8] = set.points(axis, i);
  encodeLists(lists, threads, all);
}

Fits findAndFit(const PointSet& set, const NormalOptions& options, Neighborhoods& all)
{
  if (options.image_width > 1 && options.radius == 0) {
    useLists(set, imageLists(set.points, options.image_width, options.k, options.threads), options.threads, all);
    return fitLists(all, options.threads);
  }
  all.tree = std::make_unique<PointTree>(set.points, options.threads);
  if (options.radius == 0)
    return fitNearest(all, options.k, options.threads);
  encodeLists(listsWithin(*all.tree, options), options.threads, all);
  return fitLists(all, options.threads);
}

/// Unit normal that `fit` and the direction `view` leave, oriented to `view`; NaN if they leave none.
Eigen::Vector3f normalOf(const Plane& fit, const Eigen::Vector3f& view)
{
  Eigen::Vector3f normal = fit.normal;
  if (fit.shape() == Plane::line)
    normal = view - fit.normal.dot(view) * fit.normal;
  else if (fit.shape() == Plane::point)
    normal = view;
  const float length = normal.norm();
  if (!(length > 0) || !std::isfinite(length))
    return Eigen::Vector3f::Constant(NAN);
  return (normal.dot(view) < 0 ? -1 : 1) / length * normal;
}

/// 0..1: few neighbours, or farther ones than the neighbours themselves have, count little.
/// @param densities points per area of each neighbourhood, any common factor
float confidenceOf(const GroupLists& lists, const std::vector<float>& densities, Index i)
{
  const float count = lists.count(i);
  float around = 0;
  for (std::size_t j = 0; j < lists.count(i); ++j)
    around += densities[lists.position(lists.list(i)[j])] / count;
  const float company = std::clamp((count - 2) / (fewest_within - 2), 0.f, 1.f);
  return around > 0 ? company * std::min(1.f, densities[i] / around) : 0.f;
}

/// Puts confidences in place of the reaches.
void toConfidences(const Neighborhoods& all, std::vector<float>& reaches, int threads)
{
  std::vector<float> result(reaches.size());
  const auto forGroups = [&](const auto& use) {
    parallelFor(all.groups.size(), threads, [&](Index g) {
      const GroupLists& lists = all.groups[g];
      for (Index i = lists.begin; i < lists.end; ++i)
        use(lists, i);
    });
  };
  forGroups([&](const GroupLists& lists, Index i) {
    float& reach = reaches[i];
    reach = reach > 0 ? lists.count(i) / reach : 0.f;
  });
  forGroups([&](const GroupLists& lists, Index i) { result[i] = confidenceOf(lists, reaches, i); });
  reaches.swap(result);
}

/// @param fits with confidences instead of reaches
NormalField toField(const PointSet& set, Neighborhoods& all, const Fits& fits, int threads)
{
  const std::vector<float>& shares = fits.reaches;
  std::vector<char> empty(shares.size());
  for (const GroupLists& lists : all.groups)
    for (Index i = lists.begin; i < lists.end; ++i)
      empty[i] = lists.count(i) == 0;
  releaseMemory(all.groups);
  releaseMemory(all.codes);
  NormalField field;
  field.normals = Points::Constant(3, set.size(), NAN);
  field.curvatures = Eigen::VectorXf::Constant(set.size(), NAN);
  field.confidences = Eigen::VectorXf::Zero(set.size());
  parallelFor(fits.planes.size(), threads, [&](Index i) {
    const Index column = all.column(i);
    if (empty[i])
      return;
    const Plane& fit = fits.planes[i];
    const Eigen::Vector3f view = viewDirection(set.viewpoints, column, all.point(i)), normal = normalOf(fit, view);
    field.normals.col(column) = normal;
    field.curvatures[column] = std::max(0.f, fit.curvature);
    if (fit.shape() == Plane::plane) {
      const float length = view.norm();
      const float incidence = length > 0 ? std::abs(normal.dot(view)) / length : 1.f;
      field.confidences[column] = shares[i] * incidence;
    }
  });
  return field;
}
/// What is left to do with the planes.
NormalField finish(const PointSet& set, const NormalOptions& options, Neighborhoods& all, Fits fits,
                   const Progress& progress)
{
  toConfidences(all, fits.reaches, options.threads);
  report(progress, "fit planes", 0.6);
  if (options.edges)
    refitAtEdges(set, all, fits.planes, options.threads);
  report(progress, "orient normals", 0.9);
  NormalField field = toField(set, all, fits, options.threads);
  if (set.viewpoints.cols() == 0)
    orientByNeighbors(set.points, field.normals, options.threads);
  return field;
}
} // namespace

NormalField estimateNormals(const PointSet& set, const NormalOptions& options, const Progress& progress)
{
  validate(set, options);
  report(progress, "find neighbours", 0.0);
  Neighborhoods all;
  Fits fits = findAndFit(set, options, all);
  return finish(set, options, all, std::move(fits), progress);
}

NormalField estimateNormalsFromNeighbors(const PointSet& set, const NeighborLists& neighbors,
                                         const NormalOptions& options, const Progress& progress)
{
  validate(set, options);
  require(neighbors.size() == set.size(), "normals: ", neighbors.size(), " lists of neighbours for ", set.size(),
          " points");
  for (Index i = 0; i < set.size(); ++i)
    require(neighbors.count(i) <= Neighborhoods::most_neighbors, "normals: point ", i, " has ", neighbors.count(i),
            " neighbours, more than ", Neighborhoods::most_neighbors);
  for (const int j : neighbors.index)
    require(j >= 0 && j < set.size(), "normals: neighbour ", j, " is not in 0..", set.size() - 1);
  Neighborhoods all;
  useLists(set, neighbors, options.threads, all);
  Fits fits = fitLists(all, options.threads);
  return finish(set, options, all, std::move(fits), progress);
}
} // namespace fresco
