// SPDX-License-Identifier: BSD-3-Clause
#include "fusion/distance_grid.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/morton.h>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/core/robust_weights.h>
namespace fresco::fusion {
namespace {
constexpr int half_range = 1 << 20; // of places: 21 bits each in a key

std::uint64_t keyOf(const Eigen::Vector3i& place)
{
  return mortonCode(place.x() + half_range, place.y() + half_range, place.z() + half_range);
}

/// Half of the truncation: frames whose poses are off by more than that are taken for another surface.
float robustScale(float truncation) { return 0.5f * truncation; }

/// Whole numbers below; std::floor() is a call where the processor may lack an instruction for it.
Eigen::Vector3i floorOf(const Eigen::Vector3f& v)
{
  const Eigen::Vector3i towards_zero = v.cast<int>();
  return towards_zero - (towards_zero.cast<float>().array() > v.array()).matrix().cast<int>();
}

/// Bricks in the order in which they are met, most of them once.
class MetBricks {
public:
  MetBricks() { recent_.fill(Eigen::Vector3i::Constant(half_range)); }

  void add(const Eigen::Vector3i& place)
  {
    Eigen::Vector3i& recent = recent_[(place.x() & 7) | (place.y() & 7) << 3 | (place.z() & 7) << 6];
    if (place == recent)
      return;
    recent = place;
    places.push_back(place);
  }

  std::vector<Eigen::Vector3i> places;

private:
  std::array<Eigen::Vector3i, 512> recent_; ///< of each place modulo 8
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

void DistanceGrid::allocate(const DepthFrame& frame, int threads)
{
  constexpr int stride = 2;      // pixels: far less than a brick covers, so that no thing falls between
  constexpr Index rows_each = 8; // a brick two metres away covers about 16 pixels
  const float side = brick_side * cell_;
  const Index rows = (frame.height + stride - 1) / stride;
  std::vector<MetBricks> parts((rows + rows_each - 1) / rows_each);
  const auto meet = [&](Index begin, Index end) {
    MetBricks& met = parts[begin / rows_each];
    for (Index v = begin * stride; v < end * stride; v += stride)
      for (int u = 0; u < frame.width; u += stride) {
        const float z = frame.depth(v, u);
        if (z <= 0.f)
          continue;
        const Eigen::Vector3f beam = frame.beam(u, v);
        for (float s = z - truncation_; s <= z + truncation_; s += 0.5f * side)
          met.add(floorOf((frame.center + s * beam) / side));
      }
  };
  parallelRanges(rows, threads, meet, rows_each);
  for (const MetBricks& met : parts)
    for (const Eigen::Vector3i& place : met.places)
      makeBrick(place);
}

DistanceGrid::Seen DistanceGrid::see(const DepthFrame& frame, Index b) const
{
  const float side = brick_side * cell_, radius = 0.866f * side; // half of a cube's diagonal
  const Eigen::Vector3f middle = side * (places_[b].cast<float>().array() + 0.5f).matrix();
  const Eigen::Vector3f p = frame.R_world_camera.transpose() * (middle - frame.center);
  const float front = p.z() - radius;
  if (front <= 0.f)
    return {Visibility::Hidden, 0.f};
  const float reach_u = radius * frame.fx / front, reach_v = radius * frame.fy / front;
  const float u = p.x() / p.z() * frame.fx + frame.cx, v = p.y() / p.z() * frame.fy + frame.cy;
  const DepthRange range = frame.range(u - reach_u, v - reach_v, u + reach_u, v + reach_v);
  if (range.greatest == 0.f || front > range.greatest + truncation_)
    return {Visibility::Hidden, 0.f};
  const bool free = p.z() + radius < range.least - truncation_;
  return {free ? Visibility::Free : Visibility::Surface, p.z()};
}

void DistanceGrid::integrate(const DepthFrame& frame, const DistanceGrid* reference, float free_weight, int threads)
{
  parallelFor(
      size(), threads,
      [&](Index b) {
        const Seen seen = see(frame, b);
        if (seen.visibility == Visibility::Free)
          free_[b] += free_weight / seen.depth;
        else if (seen.visibility == Visibility::Surface)
          integrateBrick(frame, b, reference ? reference->bricks_[b].distance.data() : nullptr, free_weight);
      },
      64);
}

void DistanceGrid::integrateBrick(const DepthFrame& frame, Index b, const float* reference, float free_weight)
{
  const Eigen::Vector3f corner = brick_side * cell_ * places_[b].cast<float>();
  BrickView view;
  Eigen::Map<Eigen::Vector3f>(view.first) = frame.R_world_camera.transpose() * (corner - frame.center);
  Eigen::Map<Eigen::Matrix3f>(view.step[0]) = cell_ * frame.R_world_camera.transpose(); // columns: along each axis
  Brick& brick = bricks_[b];
  const float votes =
      voteKernels().vote(frame.pixels(), view, {cell_, truncation_, free_weight, robustScale(truncation_)},
                         {reference, brick.distance.data(), brick.weight.data()});
  if (votes > best_[b].votes)
    best_[b] = {frame.center, votes};
}

void DistanceGrid::finish(const DistanceGrid* reference, int threads)
{
  const float scale = robustScale(truncation_);
  next_.resize(size());
  parallelFor(size(), threads, [&](Index b) {
    for (int k = 0; k < 8; ++k)
      next_[b][k] = find(places_[b] + Eigen::Vector3i(k & 1, k >> 1 & 1, k >> 2));
    Brick& brick = bricks_[b];
    if (free_[b] <= 0.f) {
      for (int node = 0; node < brick_size; ++node)
        if (brick.weight[node] <= 0.f)
          brick.distance[node] = std::numeric_limits<float>::quiet_NaN();
      return;
    }
    for (int node = 0; node < brick_size; ++node) {
      float weight = free_[b];
      if (reference) {
        const float off = truncation_ - reference->bricks_[b].distance[node];
        weight *= gemanMcClureWeight(off * off / (scale * scale));
      }
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

std::optional<DistanceGrid::Distance> DistanceGrid::at(const Eigen::Vector3f& point, Index& near) const
{
  const Eigen::Vector3f scaled = point / cell_;
  const Eigen::Vector3i node = floorOf(scaled);
  const Eigen::Vector3f f = scaled - node.cast<float>();
  const Eigen::Vector3i place(node.x() >> 3, node.y() >> 3, node.z() >> 3);
  if (near < 0 || places_[near] != place)
    near = find(place);
  if (near < 0)
    return std::nullopt;
  const Eigen::Vector3i in(node.x() & 7, node.y() & 7, node.z() & 7);
  float d[8];
  if (in.maxCoeff() < brick_side - 1) {
    const float* lower = &bricks_[near].distance[nodeIndex(in.x(), in.y(), in.z())];
    for (int k = 0; k < 8; ++k)
      d[k] = lower[nodeIndex(k & 1, k >> 1 & 1, k >> 2)];
  } else {
    for (int k = 0; k < 8; ++k) {
      const int x = in.x() + (k & 1), y = in.y() + (k >> 1 & 1), z = in.z() + (k >> 2);
      const Index b = next_[near][x >> 3 | y >> 3 << 1 | z >> 3 << 2];
      if (b < 0)
        return std::nullopt;
      d[k] = bricks_[b].distance[nodeIndex(x & 7, y & 7, z & 7)];
    }
  }
  const auto mix = [](float from, float to, float t) { return from + t * (to - from); };
  const float y0 = mix(d[0], d[1], f.x()), y1 = mix(d[2], d[3], f.x());
  const float y2 = mix(d[4], d[5], f.x()), y3 = mix(d[6], d[7], f.x());
  const float z0 = mix(y0, y1, f.y()), z1 = mix(y2, y3, f.y());
  const float along_x = mix(mix(d[1] - d[0], d[3] - d[2], f.y()), mix(d[5] - d[4], d[7] - d[6], f.y()), f.z());
  const float value = mix(z0, z1, f.z());
  if (std::isnan(value)) // so is each of the eight without votes
    return std::nullopt;
  const Eigen::Vector3f gradient(along_x, mix(y1 - y0, y3 - y2, f.z()), z1 - z0);
  return Distance{value, gradient / cell_};
}
} // namespace fresco::fusion
