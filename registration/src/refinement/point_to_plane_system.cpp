// SPDX-License-Identifier: BSD-3-Clause
#include "refinement/point_to_plane_system.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/robust_weights.h>
#include <fresco/core/statistics.h>
namespace fresco::registration {
PairSystem& PairSystem::operator+=(const PairSystem& other)
{
  H += other.H;
  b += other.b;
  squares += other.squares;
  count += other.count;
  return *this;
}

PairJacobian::PairJacobian(const Eigen::Isometry3d& T_world_target, const Eigen::Isometry3d& T_target_source)
{
  const Eigen::Matrix3d R = T_world_target.linear();
  M_target.topLeftCorner<3, 3>() = M_target.bottomRightCorner<3, 3>() = -R;
  M_source.topLeftCorner<3, 3>() = M_source.bottomRightCorner<3, 3>() = R;
  M_source.topRightCorner<3, 3>() = -R * skew(T_target_source.translation());
}

void findMatches(const LevelPair& level, const SampleRange& range, float distance, DirectedPair& pair)
{
  const float least_cosine = std::cos(match_angle);
  const Eigen::Isometry3f& T = level.T_target_source;
  const ScanLevel &source = level.source, &target = level.target;
  for (Index k = range.begin; k < range.end; ++k) {
    Match& match = pair.matches[k];
    const Index i = source.samples[k];
    const Eigen::Vector3f x = T * source.points.col(i);
    const auto hit = target.nearest(x, distance);
    match.target = -1;
    if (hit.index < 0)
      continue;
    const Eigen::Vector3f n = target.normals.col(hit.index);
    const float cosine = n.dot(T.linear() * source.normals.col(i));
    if ((level.oriented ? cosine : std::abs(cosine)) < least_cosine ||
        target.surface_variation[hit.index] > variation_limit)
      continue;
    match = {hit.index, n.dot(x - target.points.col(hit.index))};
  }
}

void findCutoff(float voxel, DirectedPair& pair)
{
  constexpr double tukey = 4.685;      // 95 % efficiency on Gaussian noise
  constexpr Index fewest_matches = 30; // of a direction of a pair: with fewer, the median says little of the noise
  std::vector<float> residuals;
  for (const Match& match : pair.matches)
    if (match.target >= 0)
      residuals.push_back(std::abs(match.residual));
  const bool enough = static_cast<Index>(residuals.size()) >= fewest_matches;
  pair.cutoff = enough ? std::max(tukey * mad_to_sigma * median(residuals), 1e-3 * voxel) : 0.0;
}

void addMatch(const LevelPair& level, const DirectedPair& pair, Index k, PairSystem& system)
{
  // Of both neighbourhoods together: halves the weight, noisy surfaces say less.
  constexpr double plain_variation = 0.01;
  const ScanLevel &source = level.source, &target = level.target;
  const Match& match = pair.matches[k];
  const double u = match.target < 0 || pair.cutoff <= 0.0 ? 1.0 : std::abs(match.residual) / pair.cutoff;
  if (u >= 1.0)
    return;
  const Index i = source.samples[k];
  const Eigen::Vector3d x = (level.T_target_source * source.points.col(i)).cast<double>();
  const Eigen::Vector3d n = target.normals.col(match.target).cast<double>();
  const double variation = source.surface_variation[i] + target.surface_variation[match.target];
  const double weight = pair.weight * tukeyWeight(u * u) * plain_variation / (plain_variation + variation);
  const double r = match.residual;
  Vector6d J;
  J << x.cross(n), n;
  system.H.noalias() += weight * J * J.transpose();
  system.b += weight * r * J;
  system.squares += r * r;
  ++system.count;
}

PairSystem accumulate(const LevelPair& level, const SampleRange& range, const DirectedPair& pair)
{
  PairSystem system;
  for (Index k = range.begin; k < range.end; ++k)
    addMatch(level, pair, k, system);
  return system;
}
} // namespace fresco::registration
