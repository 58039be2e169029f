// SPDX-License-Identifier: BSD-3-Clause
#include "distance/mesh_distance_statistics.h"
#include <algorithm>
#include <cmath>
namespace fresco::distance {
namespace {
// Linear between the two values that enclose the rank; reorders `values`, which must not be empty.
double quantile(std::vector<double>& values, double share)
{
  const double rank = share * (values.size() - 1);
  const auto lower = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), lower, values.end());
  const double fraction = rank - std::floor(rank);
  if (fraction == 0.0)
    return *lower;
  return *lower + fraction * (*std::min_element(lower + 1, values.end()) - *lower);
}
} // namespace

DistanceStatistics statistics(const std::vector<ClosestPoint>& closest)
{
  DistanceStatistics result;
  result.count = closest.size();
  double sum = 0.0, squares = 0.0;
  for (const ClosestPoint& c : closest) {
    result.max = std::max(result.max, c.distance);
    sum += c.distance;
    squares += c.distance * c.distance;
  }
  if (result.count > 0) {
    result.mean = sum / result.count;
    result.rms = std::sqrt(squares / result.count);
  }
  return result;
}

TwoSidedDistance twoSided(const DistanceStatistics& to_reference, const DistanceStatistics& from_reference)
{
  const DistanceStatistics &a = to_reference, &b = from_reference;
  return {a, b, {std::max(a.max, b.max), std::max(a.mean, b.mean), std::max(a.rms, b.rms), a.count + b.count}};
}

bool mostlyOpposite(std::vector<double> angles) { return !angles.empty() && quantile(angles, 0.5) > 90.0; }

NormalDeviation deviation(std::vector<double> angles, bool turned)
{
  NormalDeviation result;
  result.count = angles.size();
  if (angles.empty())
    return result;
  double sum = 0.0;
  Index above = 0;
  for (double& angle : angles) {
    angle = turned ? 180.0 - angle : angle;
    sum += angle;
    above += angle > 20.0;
  }
  result.mean = sum / result.count;
  result.share_above_20 = above / (1.0 * result.count);
  result.median = quantile(angles, 0.5);
  result.percentile95 = quantile(angles, 0.95);
  return result;
}
} // namespace fresco::distance
