// SPDX-License-Identifier: BSD-3-Clause
#include "search/tree_items.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/search/neighbors.h>
namespace fresco {
using search::TreeItem;
/// Leaves begin .. end - 1, to be cut in two by nodes_[node].
struct PointTree::Part {
  Index node, begin, end;
  Index middle() const { return begin + (end - begin + 1) / 2; }
  Part left() const { return {node + 1, begin, middle()}; }
  Part right() const { return {node + middle() - begin, middle(), end}; }
};

/// The box around points. The fourth of each number is that of no axis.
struct PointTree::Box {
  Eigen::Array4f low, high;
  Box(const TreeItem* begin, const TreeItem* end)
  {
    using Item = Eigen::Map<const Eigen::Array4f, Eigen::Aligned16>;
    low = high = Item(begin->x);
    for (const TreeItem* item = begin; item != end; ++item) {
      low = low.min(Item(item->x));
      high = high.max(Item(item->x));
    }
  }
  int longest() const
  {
    int axis = 0;
    (high - low).head<3>().maxCoeff(&axis);
    return axis;
  }
};

struct PointTree::OpenPart {
  Part part;
  Box box;
};

PointTree::PointTree(const Points& points, int threads)
{
  require(points.cols() < std::numeric_limits<int>::max(), "neighbour search: ", points.cols(), " points are too many");
  std::vector<TreeItem> items;
  items.reserve(points.cols());
  for (Index i = 0; i < points.cols(); ++i)
    if (points.col(i).allFinite())
      items.push_back({{points(0, i), points(1, i), points(2, i)}, int(i)});
  leaves_ = (items.size() + leaf_size - 1) / leaf_size;
  nodes_.resize(std::max<Index>(0, leaves_ - 1));
  build(items, threads);
  columns_.resize(items.size());
  coordinates_.assign(leaves_ * 3 * leaf_size, std::numeric_limits<float>::infinity());
  parallelFor(size(), threads, [&](Index i) {
    columns_[i] = items[i].column;
    for (int axis = 0; axis < 3; ++axis)
      coordinates_[(i / leaf_size * 3 + axis) * leaf_size + i % leaf_size] = items[i].x[axis];
  });
}

/// Cuts level by level in parallel until there are parts enough, then each part to the end.
void PointTree::build(std::vector<TreeItem>& items, int threads)
{
  std::vector<OpenPart> parts;
  if (leaves_ > 1)
    parts.push_back({{0, 0, leaves_}, Box(items.data(), items.data() + items.size())});
  for (int level = 0; level < 7 && !parts.empty(); ++level) {
    std::vector<std::vector<OpenPart>> halves(parts.size());
    const auto cut = [&](Index p) { split(items, parts[p], halves[p]); };
    parallelFor(parts.size(), threads, cut, 1);
    parts.clear();
    for (const auto& two : halves)
      parts.insert(parts.end(), two.begin(), two.end());
  }
  const auto cutWhole = [&](Index p) {
    std::vector<OpenPart> open = {parts[p]};
    while (!open.empty()) {
      const OpenPart part = open.back();
      open.pop_back();
      split(items, part, open);
    }
  };
  parallelFor(parts.size(), threads, cutWhole, 1);
}

void PointTree::split(std::vector<TreeItem>& items, const OpenPart& open, std::vector<OpenPart>& parts)
{
  const Part& part = open.part;
  TreeItem* const begin = items.data() + part.begin * leaf_size;
  TreeItem* const middle = items.data() + part.middle() * leaf_size;
  TreeItem* const end = items.data() + std::min<Index>(part.end * leaf_size, items.size());
  const int axis = open.box.longest();
  search::selectMiddle(begin, middle, end, axis);
  const Box left(begin, middle), right(middle, end);
  nodes_[part.node] = {left.high[axis], right.low[axis], axis};
  if (part.middle() - part.begin > 1)
    parts.push_back({part.left(), left});
  if (part.end - part.middle() > 1)
    parts.push_back({part.right(), right});
}

Points PointTree::points() const
{
  Points sorted(3, size());
  for (Index i = 0; i < size(); ++i)
    sorted.col(i) = point(i);
  return sorted;
}

namespace {
/// The squared distances of a leaf are offered to a collector, which keeps what is closer than its `bound`.
struct NearestOne {
  float bound;
  Index position = -1;
  void offer(const float* squared_distances, Index first, Index count)
  {
    for (Index i = 0; i < count; ++i)
      if (squared_distances[i] < bound) {
        bound = squared_distances[i];
        position = first + i;
      }
  }
};

struct NearestFew {
  std::vector<PointTree::Key>& keys; ///< as large as it may become
  std::size_t k;
  float bound;
  std::size_t size = 0;
  void offer(const float* squared_distances, Index first, Index count)
  {
    if (size + count > keys.size())
      shrink();
    for (Index i = 0; i < count; ++i) {
      keys[size] = PointTree::key(squared_distances[i], first + i);
      size += squared_distances[i] < bound;
    }
  }
  void shrink()
  {
    if (size <= k)
      return;
    std::nth_element(keys.begin(), keys.begin() + (k - 1), keys.begin() + size);
    size = k;
    bound = PointTree::squaredDistance(keys[k - 1]);
  }
};

struct AllWithin {
  std::vector<PointTree::Key>& keys;
  float bound;
  void offer(const float* squared_distances, Index first, Index count)
  {
    for (Index i = 0; i < count; ++i)
      if (squared_distances[i] < bound)
        keys.push_back(PointTree::key(squared_distances[i], first + i));
  }
};
} // namespace

/// Visits the leaves that may hold points closer than collector.bound, the near side first. The distance to a box is
/// updated with each cut (Arya & Mount 1993, "Algorithms for fast vector quantization").
template <typename Collector>
void PointTree::search(const Eigen::Vector3f& query, Collector& collector) const
{
  struct Open {
    Part part;
    float outside[3], squared_distance; // squared, per axis and in all
  };
  if (size() == 0 || !query.allFinite())
    return;
  Open stack[64];
  int height = 0;
  stack[height++] = {{0, 0, leaves_}, {0, 0, 0}, 0};
  while (height > 0) {
    Open open = stack[--height];
    if (!(open.squared_distance < collector.bound))
      continue;
    while (open.part.end - open.part.begin > 1) {
      const Node& node = nodes_[open.part.node];
      const float x = query[node.axis];
      const Part left = open.part.left(), right = open.part.right();
      const bool left_first = x + x < node.low + node.high;
      const float gap = left_first ? node.high - x : x - node.low;
      Open& other = stack[height];
      other = open;
      other.part = left_first ? right : left;
      if (gap > 0) {
        other.squared_distance += std::max(0.f, gap * gap - other.outside[node.axis]);
        other.outside[node.axis] = std::max(other.outside[node.axis], gap * gap);
      }
      // Rounding must not cut off a point that is as near as the bound.
      height += other.squared_distance * (1.f - 1e-6f) < collector.bound;
      open.part = left_first ? left : right;
    }
    const float* leaf = coordinates_.data() + open.part.begin * 3 * leaf_size;
    float squared_distances[leaf_size];
    for (Index i = 0; i < leaf_size; ++i) {
      const float dx = leaf[i] - query[0], dy = leaf[leaf_size + i] - query[1], dz = leaf[2 * leaf_size + i] - query[2];
      squared_distances[i] = dx * dx + dy * dy + dz * dz;
    }
    collector.offer(squared_distances, open.part.begin * leaf_size, leaf_size);
  }
}

Neighbor PointTree::nearest(const Eigen::Vector3f& query, float max_distance) const
{
  NearestOne collector{max_distance * max_distance};
  search(query, collector);
  return {collector.position < 0 ? -1 : columns_[collector.position], collector.bound};
}

void PointTree::nearestKeys(const Eigen::Vector3f& query, int k, std::vector<Key>& found, float bound) const
{
  require(k > 0, "neighbour search: k ", k, " is below 1");
  found.resize(3 * std::min<Index>(k, size()) + 64);
  NearestFew collector{found, std::size_t(k), std::nextafter(bound, std::numeric_limits<float>::infinity())};
  search(query, collector);
  collector.shrink();
  found.resize(collector.size);
}

void PointTree::withinKeys(const Eigen::Vector3f& query, float radius, std::vector<Key>& found, bool sorted) const
{
  require(radius >= 0, "neighbour search: radius ", radius, " is negative or NaN");
  found.clear();
  AllWithin collector{found, std::nextafter(radius * radius, std::numeric_limits<float>::infinity())};
  search(query, collector);
  if (sorted)
    std::sort(found.begin(), found.end(), [](Key a, Key b) { return position(a) < position(b); });
}

void PointTree::leavesWithin(const Eigen::Vector3f& low, const Eigen::Vector3f& high, std::vector<int>& leaves) const
{
  leaves.clear();
  if (leaves_ == 0)
    return;
  Part stack[64];
  int height = 0;
  stack[height++] = {0, 0, leaves_};
  while (height > 0) {
    Part part = stack[--height];
    while (part.end - part.begin > 1) {
      const Node& node = nodes_[part.node];
      const bool in_left = low[node.axis] <= node.low, in_right = high[node.axis] >= node.high;
      if (!in_left && !in_right)
        break;
      if (in_left && in_right)
        stack[height++] = part.right();
      part = in_left ? part.left() : part.right();
    }
    if (part.end - part.begin == 1)
      leaves.push_back(part.begin);
  }
}

std::vector<Index> PointTree::subtrees(Index most) const
{
  std::vector<Index> first;
  std::vector<Part> open;
  if (leaves_ > 0)
    open.push_back({0, 0, leaves_});
  while (!open.empty()) {
    const Part part = open.back();
    open.pop_back();
    if (part.end - part.begin <= most) {
      first.push_back(part.begin);
      continue;
    }
    open.push_back(part.right());
    open.push_back(part.left());
  }
  first.push_back(leaves_);
  return first;
}

namespace {
void toNeighbors(std::vector<PointTree::Key>& keys, const std::vector<int>& columns, std::vector<Neighbor>& found)
{
  std::sort(keys.begin(), keys.end());
  found.clear();
  for (const auto key : keys)
    found.push_back({columns[PointTree::position(key)], PointTree::squaredDistance(key)});
}
} // namespace

void PointTree::nearest(const Eigen::Vector3f& query, int k, std::vector<Neighbor>& found) const
{
  thread_local std::vector<Key> keys;
  nearestKeys(query, k, keys);
  toNeighbors(keys, columns_, found);
}

void PointTree::within(const Eigen::Vector3f& query, float radius, std::vector<Neighbor>& found) const
{
  thread_local std::vector<Key> keys;
  withinKeys(query, radius, keys);
  toNeighbors(keys, columns_, found);
}
} // namespace fresco
