// SPDX-License-Identifier: BSD-3-Clause
#include "scan/scan_planes.h"
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <map>
namespace fresco::registration {
namespace {
constexpr float same_direction = 0.985f; // cosine of 10 degrees: normals on a wall, with noise
constexpr float flat_variation = 0.05f;  // half of variation_limit: planes, not edges

bool isFlat(const ScanLevel& level, Index i)
{
  return level.surface_variation[i] < flat_variation && level.normals.col(i).squaredNorm() > 0.5f;
}

// The direction that most normals keep to, among those at a right angle to `other` unless it is zero; zero without any.
Eigen::Vector3f commonDirection(const ScanLevel& level, const Eigen::Vector3f& other)
{
  constexpr Index candidates = 300, voters = 3000; // enough that no wall is missed
  constexpr float right_angle = 0.15f;             // cosine of 81 degrees
  constexpr Index fewest = 20;                     // points that make a direction
  const Index n = level.points.cols(), step = std::max<Index>(1, n / candidates),
              every = std::max<Index>(1, n / voters);
  Eigen::Vector3f best = Eigen::Vector3f::Zero();
  Index most = fewest;
  for (Index i = 0; i < n; i += step) {
    const Eigen::Vector3f direction = level.normals.col(i);
    if (!isFlat(level, i) || std::abs(direction.dot(other)) > right_angle)
      continue;
    Index votes = 0;
    for (Index k = 0; k < n; k += every)
      votes += isFlat(level, k) && std::abs(level.normals.col(k).dot(direction)) > same_direction ? 1 : 0;
    if (votes > most) {
      most = votes;
      best = direction;
    }
  }
  return best;
}

// Mean of the normals that keep to a direction.
Eigen::Vector3f meanDirection(const ScanLevel& level, Eigen::Vector3f direction)
{
  constexpr int rounds = 5; // the mean settles in fewer
  for (int round = 0; round < rounds; ++round) {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (Index i = 0; i < level.points.cols(); ++i) {
      const float cosine = level.normals.col(i).dot(direction);
      if (isFlat(level, i) && std::abs(cosine) > same_direction)
        sum += std::copysign(1.f, cosine) * level.normals.col(i);
    }
    direction = sum.stableNormalized();
  }
  return direction;
}

void fillHistogram(const std::vector<Index>& places, PlaneHistogram& histogram)
{
  if (places.empty())
    return;
  const auto [low, high] = std::minmax_element(places.begin(), places.end());
  histogram.first = *low - 1;
  histogram.weights.assign(*high - *low + 3, 0.f);
  for (const Index place : places)
    for (const int side : {-1, 0, 1}) // a wall between two bins counts in both
      histogram.weights[place - histogram.first + side] += side == 0 ? 1.f : 0.5f;
  for (float& weight : histogram.weights)
    weight = std::sqrt(weight); // else floor and ceiling drown the rest
}
} // namespace

ScanPlanes findPlanes(const PreparedScan& scan)
{
  ScanPlanes planes;
  const ScanLevel& level = scan.levels[check_level]; // fine enough for the thickness of a wall
  const Eigen::Vector3f first = meanDirection(level, commonDirection(level, Eigen::Vector3f::Zero()));
  const Eigen::Vector3f second = meanDirection(level, commonDirection(level, first));
  if (first.isZero() || second.isZero())
    return planes;
  Eigen::Matrix3f axes;
  axes << first, second, first.cross(second);
  const Eigen::JacobiSVD<Eigen::Matrix3f> svd(axes, Eigen::ComputeFullU | Eigen::ComputeFullV);
  planes.axes = svd.matrixU() * svd.matrixV().transpose(); // the nearest rotation
  planes.bin = scan.levels.back().voxel;
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, 1}) {
      std::vector<Index> places;
      const Eigen::Vector3f direction = (side == 1 ? 1.f : -1.f) * planes.axes.col(axis);
      for (Index i = 0; i < level.points.cols(); ++i)
        if (isFlat(level, i) && level.normals.col(i).dot(direction) > same_direction)
          places.push_back(std::lround(level.points.col(i).dot(planes.axes.col(axis)) / planes.bin));
      fillHistogram(places, planes.histograms[axis][side]);
    }
  return planes;
}

std::optional<float> fullestBin(const std::vector<float>& places, float width)
{
  std::map<Index, Index> counts;
  for (const float place : places)
    ++counts[std::lround(place / width)];
  const auto most =
      std::max_element(counts.begin(), counts.end(), [](const auto& x, const auto& y) { return x.second < y.second; });
  return most == counts.end() ? std::nullopt : std::optional(most->first * width);
}
} // namespace fresco::registration
