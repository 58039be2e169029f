// SPDX-License-Identifier: BSD-3-Clause
#include "edge_fit.h"
#include "view_direction.h"
#include <algorithm>
#include <cmath>
#include <fresco/common/parallel.h>
#include <limits>
#include <utility>
namespace fresco {
namespace {
constexpr float clearly_flatter = 2.5f;  // ratio of the variances of two fits that tells an edge from chance
constexpr float flatter = 1.6f;          // the same where normals around tell of an edge and rays tell the sides apart
constexpr float as_flat = 3.f;           // ratio of the variances of the two sides of a crease at most
constexpr float holding = 16.f;          // squared distance of a point that a plane holds / variance at most
constexpr float same_side = 0.866f;      // cosine between planes that form no crease
constexpr float half_same_side = 0.966f; // planes that differ from a third by no more form no crease
constexpr float grazing = 0.1f;          // cosine between ray and normal; below, the ray tells nothing
constexpr int passes = 3, passes_without_rays = 2;

PlaneFit fitList(const Neighborhoods& all, Index i)
{
  Moments moments;
  const Eigen::Vector3f here = all.points.col(i);
  for (const int* j = all.lists.first(i); j != all.lists.last(i); ++j)
    moments.add(all.points.col(*j) - here);
  return fitPlane(moments);
}

/// What the search for the best of the neighbouring fits reads, in half a cache line.
struct alignas(32) Plane {
  Eigen::Vector3f normal;
  float height;          ///< of the plane over the point along the normal
  Eigen::Vector3f point; ///< around which it was fitted
  float variance;        ///< infinite where the fit is no plane

  float squaredDistance(const Eigen::Vector3f& other) const
  {
    const float distance = normal.dot(other - point) - height;
    return distance * distance;
  }
  /// Small for a flat fit that holds the point `other`.
  float score(const Eigen::Vector3f& other) const { return variance + 0.5f * squaredDistance(other); }
};

std::vector<Plane> toPlanes(const Neighborhoods& all, const std::vector<PlaneFit>& fits, int threads)
{
  std::vector<Plane> planes(fits.size());
  parallelFor(all.lists.size(), threads, [&](Index i) {
    const PlaneFit& fit = fits[i];
    planes[i] = {fit.normal, fit.normal.dot(fit.center), all.points.col(i),
                 fit.shape == PlaneFit::plane ? fit.variance : std::numeric_limits<float>::infinity()};
  });
  return planes;
}

struct Choice {
  Index fit;   ///< the clearly flatter one that holds the point, or the point itself
  bool crease; ///< some neighbours have another plane
};

/// @param ratio of variances that is clear where normals around tell of an edge too
Choice flattestAround(const Neighborhoods& all, const std::vector<Plane>& planes, Index i, float ratio)
{
  const Plane& own = planes[i];
  Choice choice = {i, false};
  if (!std::isfinite(own.variance))
    return choice;
  float best_score = own.variance / ratio, closest = 1;
  for (const int* j = all.lists.first(i); j != all.lists.last(i); ++j) {
    closest = std::min(closest, std::abs(planes[*j].normal.dot(own.normal)));
    if (!(planes[*j].variance < best_score))
      continue;
    const float score = planes[*j].score(own.point);
    if (score < best_score) {
      best_score = score;
      choice.fit = *j;
    }
  }
  choice.crease = closest < half_same_side;
  if (!choice.crease && best_score * clearly_flatter > own.variance)
    choice.fit = i;
  return choice;
}

/// Plane of fit j as seen from point i: offset of its centre and normal towards the viewer.
struct Side {
  Eigen::Vector3f center, normal;
  /// How far behind the point the ray meets the plane. @param ray unit, away from the viewer
  float depth(const Eigen::Vector3f& ray) const { return normal.dot(center) / normal.dot(ray); }
};

Side sideOf(const PlaneFit& fit, const Eigen::Vector3f& offset, const Eigen::Vector3f& ray)
{
  return {fit.center + offset, fit.normal.dot(ray) > 0 ? Eigen::Vector3f(-fit.normal) : fit.normal};
}

/// The best fit around point i to the other side of a crease that is as flat and holds the point; -1 if there is none.
Index otherSide(const Neighborhoods& all, const std::vector<Plane>& planes, Index i, Index first)
{
  Index second = -1;
  float best_score = std::numeric_limits<float>::infinity();
  for (const int* j = all.lists.first(i); j != all.lists.last(i); ++j) {
    const Plane& plane = planes[*j];
    const float score = plane.score(planes[i].point);
    if (plane.variance <= as_flat * planes[first].variance && score < best_score &&
        score - plane.variance <= 0.5f * holding * plane.variance &&
        std::abs(plane.normal.dot(planes[first].normal)) < same_side) {
      second = *j;
      best_score = score;
    }
  }
  return second;
}

/// Whether the ray sees `b` and not `a`, if they meet in a crease.
/// @param ray unit, away from the viewer
bool seesSecond(const Side& a, const Side& b, const Eigen::Vector3f& ray)
{
  const float a_over_b = b.normal.dot(a.center - b.center), b_over_a = a.normal.dot(b.center - a.center);
  if (!(a_over_b * b_over_a > 0) || a.normal.dot(ray) > -grazing || b.normal.dot(ray) > -grazing)
    return false; // neither hollow nor ridge
  const bool hollow = a_over_b > 0;
  return (b.depth(ray) < a.depth(ray)) == hollow;
}

/// Fit to the neighbours of `i` and of `start`, weighted by a Gaussian of the distance to the plane of `start` of twice
/// its standard deviation.
PlaneFit fitNear(const Neighborhoods& all, const std::vector<PlaneFit>& fits, Index i, Index start)
{
  const Eigen::Vector3f here = all.points.col(i);
  PlaneFit plane = fits[start];
  plane.center += all.points.col(start) - here;
  const float scale = -0.125f / std::max(plane.variance, std::numeric_limits<float>::min());
  Moments moments;
  for (const Index list : {i, start})
    for (const int* j = all.lists.first(list); j != all.lists.last(list); ++j) {
      const Eigen::Vector3f offset = all.points.col(*j) - here;
      const float distance = plane.distance(offset);
      moments.add(offset, std::exp(scale * distance * distance));
    }
  const PlaneFit better = fitPlane(moments);
  return better.shape == PlaneFit::plane ? better : plane;
}
} // namespace

std::vector<PlaneFit> fitLists(const Neighborhoods& all, int threads)
{
  std::vector<PlaneFit> fits(static_cast<std::size_t>(all.lists.size()));
  parallelFor(all.lists.size(), threads, [&](Index i) { fits[i] = fitList(all, i); });
  return fits;
}

void refitAtEdges(const PointSet& set, const Neighborhoods& all, std::vector<PlaneFit>& fits, int threads)
{
  std::vector<char> changed(fits.size(), 1);
  const bool rays = set.viewpoints.cols() > 0;
  for (int pass = 0; pass < (rays ? passes : passes_without_rays); ++pass) {
    const std::vector<char> changed_before(changed);
    const std::vector<Plane> planes = toPlanes(all, fits, threads);
    std::vector<PlaneFit> better(fits);
    parallelFor(all.lists.size(), threads, [&](Index i) {
      changed[i] = std::any_of(all.lists.first(i), all.lists.last(i), [&](int j) { return changed_before[j] != 0; });
      if (!changed[i])
        return;
      auto [best, crease] = flattestAround(all, planes, i, rays ? flatter : clearly_flatter);
      const Eigen::Vector3f view = viewDirection(set, all.columns[static_cast<std::size_t>(i)]);
      const Index other = crease && view.squaredNorm() > 0 ? otherSide(all, planes, i, best) : -1;
      if (other >= 0) {
        const Eigen::Vector3f ray = -view.normalized(), here = planes[i].point;
        if (seesSecond(sideOf(fits[best], planes[best].point - here, ray),
                       sideOf(fits[other], planes[other].point - here, ray), ray))
          best = other;
      }
      changed[i] = best != i;
      if (best != i)
        better[i] = fitNear(all, fits, i, best);
    });
    fits.swap(better);
  }
}
} // namespace fresco
