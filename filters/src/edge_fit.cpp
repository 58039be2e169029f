// SPDX-License-Identifier: BSD-3-Clause
#include "edge_fit.h"
#include <algorithm>
#include <cmath>
#include <fresco/common/parallel.h>
#include <limits>
namespace fresco {
namespace {
/// Ratio of the variances of two fits that tells an edge from chance.
constexpr float clearly_flatter = 2.5f;

PlaneFit fitList(const Neighborhoods& all, Index i)
{
  Moments moments;
  const Eigen::Vector3f here = all.points.col(i);
  for (const int* j = all.lists.first(i); j != all.lists.last(i); ++j)
    moments.add(all.points.col(*j) - here);
  return fitPlane(moments);
}

/// The fit around `i` that is clearly flatter than that of `i` and whose plane holds the point; else i.
Index flattestAround(const Neighborhoods& all, const std::vector<PlaneFit>& fits, Index i)
{
  Index best = i;
  float best_score = fits[i].variance / clearly_flatter;
  for (const int* j = all.lists.first(i); j != all.lists.last(i); ++j) {
    const PlaneFit& fit = fits[*j];
    if (fit.shape != PlaneFit::plane || !(fit.variance < best_score))
      continue;
    const float distance = fit.distance(all.points.col(i) - all.points.col(*j));
    const float score = fit.variance + 0.5f * distance * distance;
    if (score < best_score) {
      best_score = score;
      best = *j;
    }
  }
  return best;
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

void refitAtEdges(const Neighborhoods& all, std::vector<PlaneFit>& fits, int threads)
{
  for (int pass = 0; pass < 2; ++pass) {
    std::vector<PlaneFit> better(fits);
    parallelFor(all.lists.size(), threads, [&](Index i) {
      const Index best = flattestAround(all, fits, i);
      if (best != i)
        better[i] = fitNear(all, fits, i, best);
    });
    fits.swap(better);
  }
}
} // namespace fresco
