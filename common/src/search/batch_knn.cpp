// SPDX-License-Identifier: BSD-3-Clause
#include "search/knn_kernels.h"
#include <algorithm>
#include <cmath>
#include <fresco/search/batch_knn.h>
#include <numeric>
namespace fresco {
namespace {
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float rounding = 1e-5f;
constexpr float leaf_margin = 1.3f;  // distance to the k-th neighbours of a leaf / that of the point before
constexpr float point_margin = 1.4f; // squared distance to the k-th neighbour of a point / that of the point before
} // namespace

BatchKnn::BatchKnn(const PointTree& tree) : tree_(tree), kernels_(search::knnKernels()) {}

search::KnnPoints BatchKnn::foundPoints()
{
  return {squared_.data(), x_.data(), y_.data(), z_.data(), position_.data(), count_};
}

void BatchKnn::enter(Index begin, Index end)
{
  first_leaf_ = begin;
  begin_ = begin * PointTree::leaf_size;
  end_ = std::min(end * PointTree::leaf_size, tree_.size());
  low_ = high_ = tree_.point(begin_);
  for (Index i = begin_ + 1; i < end_; ++i) {
    low_ = low_.cwiseMin(tree_.point(i));
    high_ = high_.cwiseMax(tree_.point(i));
  }
  gather(0, 0);
}

float BatchKnn::expectedReach(int k) const
{
  Eigen::Vector3f extent = high_ - low_;
  std::sort(extent.data(), extent.data() + 3);
  const float share = 1.f * k / (end_ - begin_);
  const float along = 0.5f * share * extent[2], across = std::sqrt(0.3183f * share * extent[2] * extent[1]);
  return std::max(along, across);
}

void BatchKnn::makeRoom(std::size_t leaf_count)
{
  const std::size_t room = 8 * leaf_count + 16;
  if (squared_.size() >= room)
    return;
  for (auto* values : {&squared_, &x_, &y_, &z_})
    values->resize(2 * room);
  for (auto* values : {&position_, &ranks_, &chosen_})
    values->resize(2 * room);
}

void BatchKnn::gather(float reach, std::size_t most)
{
  leaves_.clear();
  if (most > 0) {
    const Eigen::Vector3f margin = Eigen::Vector3f::Constant(reach * (1 + rounding));
    tree_.leavesWithin(low_ - margin, high_ + margin, leaves_);
  }
  if (leaves_.size() > most)
    leaves_.clear();
  gathered_ = leaves_.size();
  reach_ = gathered_ > 0 ? reach : -1;
  thin_coordinates_.clear();
  focus_leaf_ = -1;
  last_ = infinity;
  prepared_ = false;
  makeRoom(gathered_);
}

void BatchKnn::prepare()
{
  prepared_ = true;
  const std::size_t stride = (gathered_ + 7) / 8 * 8;
  if (focus_.size() < stride + 8) {
    coordinates_.resize(48 * stride);
    boxes_.resize(12 * stride);
    focus_.resize(2 * stride + 8);
    focus_leaves_.resize(2 * stride + 8);
  }
  for (std::size_t l = 0; l < gathered_; ++l)
    std::copy_n(tree_.leafCoordinates() + 24 * Index{leaves_[l]}, 24, coordinates_.data() + 24 * l);
  kernels_.boxes(coordinates_.data(), {boxes_.data(), gathered_, stride});
}

/// Narrows the search to the leaves within `reach` of one of the group.
void BatchKnn::focus(Index leaf, float reach)
{
  if (!prepared_)
    prepare();
  focus_leaf_ = leaf;
  focus_reach_ = reach;
  const Index center = std::lower_bound(leaves_.begin(), leaves_.begin() + gathered_, leaf) - leaves_.begin();
  const search::KnnBoxes boxes{boxes_.data(), gathered_, (gathered_ + 7) / 8 * 8};
  focus_count_ = kernels_.closeBoxes(boxes, center, reach * (1 + rounding), focus_.data());
  for (std::size_t l = 0; l < focus_count_; ++l)
    focus_leaves_[l] = leaves_[focus_[l]];
}

/// Chooses the nearest k of the points closer than `bound`. @return false if there are fewer
bool BatchKnn::choose(Index i, int k, float bound)
{
  const Eigen::Vector3f query = tree_.point(i);
  const std::size_t wanted = k;
  count_ = kernels_.offsets({coordinates_.data(), focus_.data(), focus_count_}, query.data(), bound, foundPoints());
  if (count_ < wanted)
    return false;
  limit_ = kernels_.limit(squared_.data(), count_, wanted, bound);
  if (limit_ < 0) { // equally far ones: by position
    keys_.resize(count_);
    for (std::size_t j = 0; j < count_; ++j)
      keys_[j] = PointTree::key(squared_[j], position(position_[j]));
    std::nth_element(keys_.begin(), keys_.begin() + (k - 1), keys_.end());
    keys_.resize(wanted);
    chooseByKeys(i);
  }
  return true;
}

void BatchKnn::nearest(Index i, int k)
{
  const Index leaf = i / PointTree::leaf_size;
  if (reach_ >= 0) {
    if (leaf != focus_leaf_)
      focus(leaf, std::min(reach_, leaf_margin * std::sqrt(last_)));
    const float all = focus_reach_ * focus_reach_;
    bool found = point_margin * last_ < all && choose(i, k, point_margin * last_);
    found = found || choose(i, k, all);
    if (!found && focus_reach_ < reach_) {
      focus(leaf, reach_);
      found = choose(i, k, reach_ * reach_);
    }
    if (found) {
      last_ = std::isfinite(limit_) ? limit_ : squared_[count_ - 1];
      return;
    }
  }
  tree_.nearestKeys(tree_.point(i), k, keys_);
  // Distances beyond the range of float are not found; such a point is its own neighbour instead.
  keys_.resize(k, PointTree::key(0, i));
  chooseByKeys(i);
}

int BatchKnn::codeOf(int position)
{
  const int leaf = position / 8;
  const auto end = leaves_.begin() + gathered_;
  auto at = std::lower_bound(leaves_.begin(), end, leaf);
  if (at == end || *at != leaf)
    at = std::find(end, leaves_.end(), leaf);
  if (at == leaves_.end())
    at = leaves_.insert(at, leaf);
  const int place = at - leaves_.begin();
  return 8 * place + position % 8;
}

/// Chooses the points of keys_.
void BatchKnn::chooseByKeys(Index i)
{
  std::sort(keys_.begin(), keys_.end(),
            [](PointTree::Key a, PointTree::Key b) { return PointTree::position(a) < PointTree::position(b); });
  count_ = keys_.size();
  makeRoom(count_ / 8 + 1);
  const Eigen::Vector3f query = tree_.point(i);
  for (std::size_t j = 0; j < count_; ++j) {
    const int position = PointTree::position(keys_[j]);
    const Eigen::Vector3f offset = tree_.point(position) - query;
    squared_[j] = PointTree::squaredDistance(keys_[j]);
    x_[j] = offset.x(), y_[j] = offset.y(), z_[j] = offset.z();
    position_[j] = codeOf(position);
  }
  limit_ = infinity;
}

const int* BatchKnn::sum(float* sums)
{
  kernels_.sum(foundPoints(), limit_, sums, chosen_.data());
  return chosen_.data();
}

void BatchKnn::ordered(int* positions)
{
  std::size_t k = 0;
  for (std::size_t j = 0; j < count_; ++j)
    if (squared_[j] < limit_) {
      squared_[k] = squared_[j];
      chosen_[k++] = position(position_[j]);
    }
  kernels_.rank(squared_.data(), k, ranks_.data());
  std::fill(positions, positions + k, -1);
  for (std::size_t j = 0; j < k; ++j) {
    int rank = ranks_[j];
    while (positions[rank] >= 0) // equally far: by position
      ++rank;
    positions[rank] = chosen_[j];
  }
}

std::size_t BatchKnn::within(Index i, float radius)
{
  const Index leaf = i / PointTree::leaf_size;
  if (radius > reach_)
    return 0;
  if (leaf != focus_leaf_ || radius > focus_reach_)
    focus(leaf, std::min(reach_, leaf_margin * radius));
  const float limit = std::nextafter(radius * radius, infinity);
  return kernels_.closer({tree_.leafCoordinates(), focus_leaves_.data(), focus_count_}, tree_.point(i).data(), limit,
                         foundPoints());
}

void BatchKnn::thin(float radius, int wanted)
{
  Eigen::Vector3f extent = high_ - low_;
  std::sort(extent.data(), extent.data() + 3);
  const float around = (extent[2] + 2 * reach_) * (extent[1] + 2 * reach_), disc = 3.1416f * radius * radius;
  const float found = 8.f * gathered_ * (around > 0 ? disc / around : 1.f);
  const auto step = static_cast<std::size_t>(std::max(1.f, found / wanted));
  const std::size_t count = (8 * gathered_ + step - 1) / step, leaf_count = (count + 7) / 8;
  thin_coordinates_.assign(24 * leaf_count, infinity);
  thin_codes_.assign(8 * leaf_count, -1);
  thin_leaves_.resize(leaf_count);
  std::iota(thin_leaves_.begin(), thin_leaves_.end(), 0);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t code = i * step;
    const float* leaf = tree_.leafCoordinates() + 24 * Index{leaves_[code / 8]};
    for (std::size_t axis = 0; axis < 3; ++axis)
      thin_coordinates_[i / 8 * 24 + axis * 8 + i % 8] = leaf[axis * 8 + code % 8];
    thin_codes_[i] = code;
  }
}

std::size_t BatchKnn::keptWithin(Index i, float radius)
{
  limit_ = std::nextafter(radius * radius, infinity);
  count_ = kernels_.offsets({thin_coordinates_.data(), thin_leaves_.data(), thin_leaves_.size()}, tree_.point(i).data(),
                            limit_, foundPoints());
  for (std::size_t j = 0; j < count_; ++j)
    position_[j] = thin_codes_[position_[j]];
  return count_;
}
} // namespace fresco
