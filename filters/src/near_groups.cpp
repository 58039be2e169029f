// SPDX-License-Identifier: BSD-3-Clause
#include "near_groups.h"
#include <algorithm>
#include <cmath>
namespace fresco {
namespace {
constexpr std::size_t most_ranked = 128; // beyond, comparing all with all takes longer than a search of the tree
constexpr float rounding = 1e-5f;
} // namespace

NearGroup::NearGroup(const PointTree& tree, const NearKernels& kernels) : tree_(tree), kernels_(kernels) {}

void NearGroup::enter(Index begin, Index end)
{
  begin_ = begin * PointTree::leaf_size;
  end_ = std::min(end * PointTree::leaf_size, tree_.size());
  low_ = high_ = tree_.point(begin_);
  for (Index i = begin_ + 1; i < end_; ++i) {
    low_ = low_.cwiseMin(tree_.point(i));
    high_ = high_.cwiseMax(tree_.point(i));
  }
  leaves_.clear();
  reach_ = 0;
}

void NearGroup::gather(float reach, std::size_t most)
{
  const Eigen::Vector3f margin = Eigen::Vector3f::Constant(reach * (1 + rounding));
  tree_.leavesWithin(low_ - margin, high_ + margin, leaves_);
  if (leaves_.size() > most)
    leaves_.clear();
  reach_ = reach;
  thin_coordinates_.clear();
  const std::size_t room = 8 * leaves_.size() + 8;
  if (squared_.size() < room) {
    squared_.resize(2 * room);
    positions_.resize(2 * room);
    ranks_.resize(2 * room);
  }
}

void NearGroup::thin(std::size_t step)
{
  const std::size_t count = (8 * leaves_.size() + step - 1) / step, leaf_count = (count + 7) / 8;
  thin_coordinates_.assign(24 * leaf_count, std::numeric_limits<float>::infinity());
  thin_positions_.assign(8 * leaf_count, -1);
  thin_leaves_.resize(leaf_count);
  for (std::size_t l = 0; l < leaf_count; ++l)
    thin_leaves_[l] = static_cast<int>(l);
  for (std::size_t i = 0; i < count; ++i) {
    const int leaf = leaves_[i * step / 8], lane = static_cast<int>(i * step % 8);
    for (std::size_t axis = 0; axis < 3; ++axis)
      thin_coordinates_[i / 8 * 24 + axis * 8 + i % 8] =
          tree_.leafCoordinates()[static_cast<std::size_t>(leaf) * 24 + axis * 8 + static_cast<std::size_t>(lane)];
    thin_positions_[i] = 8 * leaf + lane;
  }
}

std::size_t NearGroup::closer(const Eigen::Vector3f& query, float squared_limit)
{
  const float limit = std::nextafter(squared_limit, std::numeric_limits<float>::infinity());
  if (thin_coordinates_.empty())
    return kernels_.closer(tree_.leafCoordinates(), leaves_.data(), leaves_.size(), query.data(), limit,
                           squared_.data(), positions_.data());
  const std::size_t count = kernels_.closer(thin_coordinates_.data(), thin_leaves_.data(), thin_leaves_.size(),
                                            query.data(), limit, squared_.data(), positions_.data());
  for (std::size_t i = 0; i < count; ++i)
    positions_[i] = thin_positions_[static_cast<std::size_t>(positions_[i])];
  return count;
}

float NearGroup::nearest(Index i, int k, float bound, int* found)
{
  const Eigen::Vector3f query = tree_.point(i);
  // All points up to the boundary of the gathered box are there.
  const float clearance = reach_ + std::min((query - low_).minCoeff(), (high_ - query).minCoeff());
  const std::size_t count = closer(query, std::min(bound, clearance * clearance));
  if (count < static_cast<std::size_t>(k) || count > most_ranked) {
    tree_.nearestKeys(query, k, keys_, bound);
    std::sort(keys_.begin(), keys_.end());
    // Distances beyond the range of float are not found; such a point is its own neighbour instead.
    keys_.resize(static_cast<std::size_t>(k), PointTree::key(std::numeric_limits<float>::infinity(), i));
    std::transform(keys_.begin(), keys_.end(), found, PointTree::position);
    return PointTree::squaredDistance(keys_.back());
  }
  kernels_.rank(squared_.data(), count, ranks_.data());
  std::fill(found, found + k, -1);
  float last = 0;
  for (std::size_t j = 0; j < count; ++j) {
    int rank = ranks_[j];
    while (rank < k && found[rank] >= 0) // equally far: by position
      ++rank;
    if (rank < k) {
      found[rank] = positions_[j];
      last = std::max(last, squared_[j]);
    }
  }
  return last;
}

std::size_t NearGroup::within(Index i, float radius) { return closer(tree_.point(i), radius * radius); }
} // namespace fresco
