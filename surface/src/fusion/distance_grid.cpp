// SPDX-License-Identifier: BSD-3-Clause
#include "fusion/distance_grid.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/morton.h>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
namespace fresco::fusion {
namespace {
constexpr int half_range = 1 << 20; // of places: 21 bits each in a key

std::uint64_t keyOf(const Eigen::Vector3i& place)
{
  return mortonCode(place.x() + half_range, place.y() + half_range, place.z() + half_range);
}

/// Weight of a vote that lies `residual` from the reference: Geman & McClure 1987.
float robustWeight(float residual, float scale)
{
  const float t = 1.f + residual * residual / (scale * scale);
  return 1.f / (t * t);
}

/// Half of the truncation: frames whose poses are off by more than that are taken for another surface.
float robustScale(float truncation) { return 0.5f * truncation; }

/// Where a frame sees the nodes of a row.
struct PixelRow {
  float z[brick_side], inverse[brick_side], u[brick_side], v[brick_side];

  /// @param first, step in the camera's frame
  PixelRow(const DepthFrame& frame, const Eigen::Vector3f& first, const Eigen::Vector3f& step)
  {
    for (int i = 0; i < brick_side; ++i) {
      z[i] = first.z() + i * step.z();
      // The weight of a vote lies between that for the error of the poses, the same near and far, and 1 / variance of
      // the noise, which falls with z^4.
      inverse[i] = 1.f / z[i];
      u[i] = (first.x() + i * step.x()) * inverse[i] * frame.fx + frame.cx;
      v[i] = (first.y() + i * step.y()) * inverse[i] * frame.fy + frame.cy;
    }
  }
};
} // namespace

DistanceGrid::DistanceGrid(double cell, double truncation) : cell_(cell), truncation_(truncation) {}

bool DistanceGrid::makeBrick(const Eigen::Vector3i& place)
{
  require(place.cwiseAbs().maxCoeff() < half_range, "depth fusion: a surface lies more than ", half_range * brick_side,
          " cells from the origin");
  if (!index_.try_emplace(keyOf(place), bricks_.size()).second)
    return false;
  bricks_.emplace_back();
  places_.push_back(place);
  free_.push_back(0.f);
  best_.emplace_back();
  return true;
}

void DistanceGrid::allocate(const DepthFrame& frame)
{
  constexpr int stride = 2; // pixels: far less than a brick covers, so that no thing falls between
  const float side = brick_side * cell_;
  Eigen::Vector3i last = Eigen::Vector3i::Constant(half_range);
  for (int v = 0; v < frame.height; v += stride)
    for (int u = 0; u < frame.width; u += stride) {
      const float z = frame.depth(v, u);
      if (z <= 0.f)
        continue;
      const Eigen::Vector3f beam = frame.beam(u, v);
      for (float s = z - truncation_; s <= z + truncation_; s += 0.5f * side) {
        const Eigen::Vector3i place = ((frame.center + s * beam) / side).array().floor().cast<int>();
        if (place != last)
          makeBrick(place);
        last = place;
      }
    }
}

std::vector<DistanceGrid::Seen> DistanceGrid::visibleBricks(const DepthFrame& frame) const
{
  std::vector<Seen> seen;
  const float side = brick_side * cell_, radius = 0.866f * side; // half of a cube's diagonal
  for (Index b = 0; b < size(); ++b) {
    const Eigen::Vector3f middle = side * (places_[b].cast<float>().array() + 0.5f).matrix();
    const Eigen::Vector3f p = frame.R_world_camera.transpose() * (middle - frame.center);
    const float front = p.z() - radius;
    if (front <= 0.f)
      continue;
    const float reach_u = radius * frame.fx / front, reach_v = radius * frame.fy / front;
    const float u = p.x() / p.z() * frame.fx + frame.cx, v = p.y() / p.z() * frame.fy + frame.cy;
    const DepthRange range = frame.range(u - reach_u, v - reach_v, u + reach_u, v + reach_v);
    if (range.greatest == 0.f || front > range.greatest + truncation_)
      continue;
    const bool free = p.z() + radius < range.least - truncation_;
    seen.push_back({b, free ? Visibility::Free : Visibility::Surface, p.z()});
  }
  return seen;
}

void DistanceGrid::integrate(const DepthFrame& frame, const DistanceGrid* reference, float free_weight, int threads)
{
  const std::vector<Seen> seen = visibleBricks(frame);
  parallelFor(
      seen.size(), threads,
      [&](Index i) {
        const Index b = seen[i].brick;
        if (seen[i].visibility == Visibility::Free)
          free_[b] += free_weight / seen[i].depth;
        else
          integrateBrick(frame, b, reference ? &reference->bricks_[b] : nullptr, free_weight);
      },
      16);
}

void DistanceGrid::integrateBrick(const DepthFrame& frame, Index b, const Brick* reference, float free_weight)
{
  const Eigen::Matrix3f step = cell_ * frame.R_world_camera.transpose(); // columns: one node on along each axis
  const Eigen::Vector3f corner = brick_side * cell_ * places_[b].cast<float>();
  const Eigen::Vector3f first = frame.R_world_camera.transpose() * (corner - frame.center);
  const float scale = robustScale(truncation_);
  Brick& brick = bricks_[b];
  float votes = 0;
  for (int row = 0; row < brick_side * brick_side; ++row) {
    const PixelRow pixels(frame, first + row % brick_side * step.col(1) + row / brick_side * step.col(2), step.col(0));
    for (int x = 0; x < brick_side; ++x) {
      const float z = pixels.z[x] > cell_ ? frame.depthAt(pixels.u[x], pixels.v[x]) : 0.f;
      float distance = z - pixels.z[x];
      if (z <= 0.f || distance < -truncation_)
        continue;
      const int node = row * brick_side + x;
      float weight = pixels.inverse[x];
      if (distance > truncation_) {
        distance = truncation_;
        weight *= free_weight;
      } else {
        votes += weight;
      }
      if (reference)
        weight *= robustWeight(distance - reference->distance[node], scale);
      brick.weight[node] += weight;
      brick.distance[node] += weight / brick.weight[node] * (distance - brick.distance[node]);
    }
  }
  if (votes > best_[b].votes)
    best_[b] = {frame.center, votes};
}

void DistanceGrid::finish(const DistanceGrid* reference, int threads)
{
  const float scale = robustScale(truncation_);
  parallelFor(size(), threads, [&](Index b) {
    if (free_[b] <= 0.f)
      return;
    Brick& brick = bricks_[b];
    for (int node = 0; node < brick_size; ++node) {
      float weight = free_[b];
      if (reference)
        weight *= robustWeight(truncation_ - reference->bricks_[b].distance[node], scale);
      brick.weight[node] += weight;
      brick.distance[node] += weight / brick.weight[node] * (truncation_ - brick.distance[node]);
    }
  });
}

DistanceGrid DistanceGrid::emptied() const
{
  DistanceGrid grid(cell_, truncation_);
  grid.index_ = index_;
  grid.places_ = places_;
  grid.bricks_.resize(size());
  grid.free_.resize(size(), 0.f);
  grid.best_.resize(size());
  return grid;
}

Index DistanceGrid::find(const Eigen::Vector3i& place) const
{
  if (place.cwiseAbs().maxCoeff() >= half_range)
    return -1;
  const auto found = index_.find(keyOf(place));
  return found == index_.end() ? -1 : found->second;
}

std::optional<DistanceGrid::Distance> DistanceGrid::at(const Eigen::Vector3f& point) const
{
  const Eigen::Vector3f scaled = point / cell_;
  const Eigen::Vector3i node = scaled.array().floor().cast<int>();
  const Eigen::Vector3f f = scaled - node.cast<float>();
  float d[8];
  Eigen::Vector3i last = Eigen::Vector3i::Constant(half_range);
  Index b = -1;
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3i at = node + Eigen::Vector3i(k & 1, k >> 1 & 1, k >> 2);
    const Eigen::Vector3i place(at.x() >> 3, at.y() >> 3, at.z() >> 3);
    if (place != last)
      b = find(place);
    last = place;
    const int i = nodeIndex(at.x() & 7, at.y() & 7, at.z() & 7);
    if (b < 0 || bricks_[b].weight[i] <= 0.f)
      return std::nullopt;
    d[k] = bricks_[b].distance[i];
  }
  const auto mix = [](float from, float to, float t) { return from + t * (to - from); };
  const float y0 = mix(d[0], d[1], f.x()), y1 = mix(d[2], d[3], f.x());
  const float y2 = mix(d[4], d[5], f.x()), y3 = mix(d[6], d[7], f.x());
  const float z0 = mix(y0, y1, f.y()), z1 = mix(y2, y3, f.y());
  const float along_x = mix(mix(d[1] - d[0], d[3] - d[2], f.y()), mix(d[5] - d[4], d[7] - d[6], f.y()), f.z());
  const Eigen::Vector3f gradient(along_x, mix(y1 - y0, y3 - y2, f.z()), z1 - z0);
  return Distance{mix(z0, z1, f.z()), gradient / cell_};
}
} // namespace fresco::fusion
