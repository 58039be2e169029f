// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/normals_bounds.h"
#include <Eigen/Eigenvalues>
#include <fresco/core/parallel.h>
#include <limits>
namespace fresco {
using Eigen::Vector3f;

namespace {
constexpr std::size_t fewest = 3; // points of a plane

/// Points of one true surface around a point.
struct Surface {
  int first;                                          ///< a column
  std::vector<Vector3f> offsets;                      ///< from the point
  float gap = std::numeric_limits<float>::infinity(); ///< squared distance across the beam to the nearest other one
};

bool onSameSurface(const NormalSample& sample, int a, int b)
{
  const Vector3f normal = sample.truth.col(a), way = sample.exact.col(b) - sample.exact.col(a);
  return normal.dot(sample.truth.col(b)) > 0.985f && std::abs(normal.dot(way)) <= 0.001f + 0.1f * way.norm();
}

struct FittedPlane {
  Vector3f normal, center;
};

FittedPlane fit(const std::vector<Vector3f>& offsets)
{
  Vector3f center = Vector3f::Zero();
  for (const Vector3f& p : offsets)
    center += p / static_cast<float>(offsets.size());
  Eigen::Matrix3f A = Eigen::Matrix3f::Zero();
  for (const Vector3f& p : offsets)
    A += (p - center) * (p - center).transpose();
  return {Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f>(A).eigenvectors().col(0), center};
}

/// normalOf(column, columns of the k nearest) for every point, turned to the viewer.
template <typename NormalOf>
Points forNeighborhoods(const NormalSample& sample, const PointTree& tree, int k, const NormalOf& normalOf)
{
  const NeighborLists lists = nearestLists(tree, k);
  Points normals = Points::Constant(3, sample.points.cols(), NAN);
  parallelFor(lists.size(), 0, [&](Index i) {
    std::vector<int> near(lists.first(i), lists.last(i));
    for (int& j : near)
      j = tree.columns()[j];
    const int column = tree.columns()[i];
    const Vector3f normal = normalOf(column, near);
    normals.col(column) = normal.dot(sample.ray(column)) > 0 ? Vector3f(-normal) : normal;
  });
  return normals;
}

/// Those that `near` lie on, without points of beams that met several. Gaps are over that to the nearest of all.
std::vector<Surface> surfacesAround(const NormalSample& sample, int column, const std::vector<int>& near)
{
  const Vector3f here = sample.points.col(column), ray = sample.ray(column).normalized();
  std::vector<Surface> surfaces;
  float least_gap = std::numeric_limits<float>::infinity(), widest = 0;
  for (const int j : near) {
    if (!sample.truth.col(j).allFinite())
      continue;
    std::size_t s = 0;
    while (s < surfaces.size() && !onSameSurface(sample, surfaces[s].first, j))
      ++s;
    if (s == surfaces.size())
      surfaces.push_back({j, {}});
    const Vector3f offset = sample.points.col(j) - here;
    surfaces[s].offsets.push_back(offset);
    if (j == column)
      continue;
    const float gap = (offset - offset.dot(ray) * ray).squaredNorm();
    surfaces[s].gap = std::min(surfaces[s].gap, gap);
    least_gap = std::min(least_gap, gap);
    widest = std::max(widest, gap);
  }
  for (Surface& surface : surfaces)
    surface.gap = std::min(surface.gap, widest) / std::max(least_gap, std::numeric_limits<float>::min());
  return surfaces;
}
} // namespace

Points sortedByTruth(const NormalSample& sample, const PointTree& tree, int k)
{
  return forNeighborhoods(sample, tree, k, [&](int column, const std::vector<int>& near) {
    std::vector<Vector3f> offsets;
    for (const int j : near)
      if (onSameSurface(sample, column, j))
        offsets.emplace_back(sample.points.col(j) - sample.points.col(column));
    return offsets.size() < fewest ? Vector3f(-sample.ray(column).normalized()) : fit(offsets).normal;
  });
}

Points givenToLikeliest(const NormalSample& sample, const PointTree& tree, int k, SurfacePlanes planes)
{
  return forNeighborhoods(sample, tree, k, [&](int column, const std::vector<int>& near) {
    const Vector3f ray = sample.ray(column).normalized();
    Vector3f best = -ray;
    float least = std::numeric_limits<float>::infinity();
    for (const Surface& surface : surfacesAround(sample, column, near)) {
      if (planes == SurfacePlanes::fitted && surface.offsets.size() < fewest)
        continue;
      const FittedPlane plane = planes == SurfacePlanes::fitted
                                    ? fit(surface.offsets)
                                    : FittedPlane{sample.truth.col(surface.first),
                                                  sample.exact.col(surface.first) - sample.points.col(column)};
      const float noise = sample.deviations[column] * std::abs(plane.normal.dot(ray));
      const float off = plane.normal.dot(plane.center) / std::max(noise, 1e-6f), cost = off * off + surface.gap;
      if (cost < least) {
        least = cost;
        best = plane.normal;
      }
    }
    return best;
  });
}
} // namespace fresco
