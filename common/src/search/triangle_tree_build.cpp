// SPDX-License-Identifier: BSD-3-Clause
#include "search/triangle_tree_data.h"

#include <algorithm>
#include <array>
#include <fresco/core/parallel.h>
#include <fresco/core/release.h>
#include <limits>
#include <utility>
namespace fresco {
namespace {
constexpr int bin_count = 16;        // per axis, at most
constexpr Index leaf_size = 2;       // triangles per leaf, at most
constexpr Index halved_below = 6;    // ranges up to this size are halved: a better cut does not pay there
constexpr int balanced_from = 28;    // binary splits after which ranges are halved: bounds the depth of the tree
constexpr Index task_size = 1 << 13; // triangles of a subtree that one thread builds
constexpr float huge = std::numeric_limits<float>::max();

using Vector = Eigen::Array4f; // x, y, z, 0

struct Box {
  Vector low = Vector::Constant(huge), high = Vector::Constant(-huge);

  void add(const Box& other)
  {
    low = low.min(other.low);
    high = high.max(other.high);
  }
  float halfArea() const
  {
    const Vector side = high - low;
    return side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
  }
};

struct Primitive {
  Box box;
  std::int32_t triangle;

  Vector center() const { return 0.5f * box.low + 0.5f * box.high; }
};

struct Range {
  Index begin = 0, end = 0;
  int splits = 0; // binary splits above
  Box box;

  Index size() const { return end - begin; }
};

struct Bin {
  Box box;
  Index count = 0;
};
using Bins = std::array<std::array<Bin, bin_count>, 3>; // [axis][bin]

// Maps a centre to its bin on each axis. Few primitives get few bins.
struct Binning {
  int count;
  Vector origin, scale;

  Binning(const Box& centers, Index primitives)
      : count(static_cast<int>(std::min<Index>(bin_count, 4 + primitives / 8))), origin(centers.low)
  {
    const Vector extent = centers.high - centers.low;
    for (int axis = 0; axis < 4; ++axis)
      scale[axis] = extent[axis] > 0.f ? 0.9999f * static_cast<float>(count) / extent[axis] : 0.f;
  }
  Eigen::Array4i operator()(const Vector& center) const
  {
    return ((center - origin) * scale).cast<int>().max(0).min(count - 1);
  }
};

struct Split {
  float cost = std::numeric_limits<float>::infinity();
  int axis = -1, bin = 0; // bins below `bin` go left
};

Box centerBox(const std::vector<Primitive>& primitives, Index begin, Index end)
{
  Box box;
  for (Index i = begin; i < end; ++i) {
    const Vector center = primitives[i].center();
    box.low = box.low.min(center);
    box.high = box.high.max(center);
  }
  return box;
}

Bins fillBins(const std::vector<Primitive>& primitives, const Binning& binning, Index begin, Index end)
{
  Bins bins;
  for (Index i = begin; i < end; ++i) {
    const Primitive& primitive = primitives[i];
    const Eigen::Array4i at = binning(primitive.center());
    for (int axis = 0; axis < 3; ++axis) {
      Bin& bin = bins[axis][at[axis]];
      bin.box.add(primitive.box);
      ++bin.count;
    }
  }
  return bins;
}

Bins joinBins(Bins a, const Bins& b)
{
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < bin_count; ++i) {
      a[axis][i].box.add(b[axis][i].box);
      a[axis][i].count += b[axis][i].count;
    }
  return a;
}

// `best`, or the cheapest cut of this axis where that costs less.
void improveSplit(const std::array<Bin, bin_count>& bins, int count, int axis, Split& best)
{
  const auto used = static_cast<std::size_t>(count);
  std::array<float, bin_count> right_cost;
  Bin right;
  for (std::size_t i = used - 1; i > 0; --i) {
    right.box.add(bins[i].box);
    right.count += bins[i].count;
    right_cost[i] = right.count > 0 ? right.box.halfArea() * static_cast<float>(right.count) : huge;
  }
  Bin left;
  for (std::size_t i = 1; i < used; ++i) {
    left.box.add(bins[i - 1].box);
    left.count += bins[i - 1].count;
    const float cost = left.count > 0 ? left.box.halfArea() * static_cast<float>(left.count) + right_cost[i] : huge;
    if (cost < best.cost && left.count > 0 && right_cost[i] < huge)
      best = {cost, axis, static_cast<int>(i)};
  }
}

class Builder {
public:
  Builder(std::vector<Primitive>& primitives, int threads) : primitives_(primitives), threads_(threads) {}

  std::vector<TreeNode> build()
  {
    Range all{0, static_cast<Index>(primitives_.size()), 0, {}};
    all.box = boxOf(all.begin, all.end);
    appendNode(nodes_, all, true);
    std::vector<std::vector<TreeNode>> subtrees(tasks_.size());
    parallelFor(
        tasks_.size(), threads_,
        [&](Index t) {
          const auto slot = static_cast<std::size_t>(t);
          appendNode(subtrees[slot], tasks_[slot].range, false);
        },
        1);
    joinSubtrees(subtrees);
    return std::move(nodes_);
  }

private:
  struct Task {
    Range range;
    std::int32_t parent;
    int slot;
  };

  Box boxOf(Index begin, Index end) const
  {
    Box box;
    for (Index i = begin; i < end; ++i)
      box.add(primitives_[i].box);
    return box;
  }

  Split findSplit(const Range& range, const Binning& binning) const
  {
    const auto fill = [&](Index begin, Index end) {
      return fillBins(primitives_, binning, range.begin + begin, range.begin + end);
    };
    const Bins bins = range.size() > task_size
                          ? parallelReduce(range.size(), threads_, Bins(), fill, joinBins, task_size)
                          : fill(0, range.size());
    Split best;
    for (int axis = 0; axis < 3; ++axis)
      improveSplit(bins[axis], binning.count, axis, best);
    return best;
  }

  // First primitive of the right half.
  Index partition(const Range& range)
  {
    const auto first = primitives_.begin();
    const Box centers = centerBox(primitives_, range.begin, range.end);
    const Index middle = range.begin + range.size() / 2;
    if (range.size() > halved_below && range.splits < balanced_from) {
      const Binning binning(centers, range.size());
      const Split best = findSplit(range, binning);
      if (best.axis < 0)
        return middle; // all centres in one place
      const auto right = std::partition(first + range.begin, first + range.end, [&](const Primitive& primitive) {
        return binning(primitive.center())[best.axis] < best.bin;
      });
      return right - first;
    }
    Index axis;
    (centers.high - centers.low).head<3>().maxCoeff(&axis);
    std::nth_element(first + range.begin, first + middle, first + range.end,
                     [axis](const Primitive& a, const Primitive& b) {
                       return std::pair(a.center()[axis], a.triangle) < std::pair(b.center()[axis], b.triangle);
                     });
    return middle;
  }

  // Splits until there are four ranges: the largest first.
  int splitInFour(std::array<Range, 4>& parts)
  {
    int count = 1;
    while (count < 4) {
      Range* widest = std::max_element(parts.data(), parts.data() + count, [](const Range& a, const Range& b) {
        const auto weight = [](const Range& r) { return r.size() > leaf_size ? r.box.halfArea() : -1.f; };
        return weight(a) < weight(b);
      });
      if (widest->size() <= leaf_size)
        break;
      const Range whole = *widest;
      const Index middle = partition(whole);
      *widest = {whole.begin, middle, whole.splits + 1, boxOf(whole.begin, middle)};
      parts[count++] = {middle, whole.end, whole.splits + 1, boxOf(middle, whole.end)};
    }
    return count;
  }

  // Appends the node of `range` and all below it. At the top, small ranges are left to tasks.
  std::int32_t appendNode(std::vector<TreeNode>& nodes, const Range& range, bool top)
  {
    const auto self = static_cast<std::int32_t>(nodes.size());
    nodes.emplace_back();
    std::array<Range, 4> parts{range};
    const int count = splitInFour(parts);
    for (int slot = 0; slot < 4; ++slot) {
      const Range part = slot < count ? parts[slot] : Range{};
      TreeNode& node = nodes[self];
      for (int axis = 0; axis < 3; ++axis) {
        node.low[axis][slot] = part.box.low[axis];
        node.high[axis][slot] = part.box.high[axis];
      }
      const bool leaf = part.size() <= leaf_size;
      node.child[slot] = static_cast<std::int32_t>(part.begin);
      node.count[slot] = leaf ? static_cast<std::int32_t>(part.size()) : 0;
      if (leaf)
        continue;
      if (top && part.size() <= task_size) {
        tasks_.push_back({part, self, slot});
      } else {
        const std::int32_t child = appendNode(nodes, part, top); // may move `node`
        nodes[self].child[slot] = child;
      }
    }
    return self;
  }

  void joinSubtrees(std::vector<std::vector<TreeNode>>& subtrees)
  {
    std::size_t total = nodes_.size();
    for (const auto& subtree : subtrees)
      total += subtree.size();
    nodes_.reserve(total);
    for (std::size_t t = 0; t < subtrees.size(); ++t) {
      const auto offset = static_cast<std::int32_t>(nodes_.size());
      nodes_[tasks_[t].parent].child[tasks_[t].slot] = offset;
      for (TreeNode node : subtrees[t]) {
        for (int slot = 0; slot < 4; ++slot)
          if (node.count[slot] == 0)
            node.child[slot] += offset;
        nodes_.push_back(node);
      }
      releaseMemory(subtrees[t]);
    }
  }

  std::vector<Primitive>& primitives_;
  int threads_;
  std::vector<TreeNode> nodes_;
  std::vector<Task> tasks_;
};

std::vector<Primitive> primitivesOf(const std::vector<TreeTriangle>& triangles, int threads)
{
  std::vector<Primitive> primitives(triangles.size());
  parallelFor(triangles.size(), threads, [&](Index i) {
    Primitive& primitive = primitives[i];
    primitive.triangle = static_cast<std::int32_t>(i);
    for (const auto& corner : triangles[i].corner) {
      const Vector point(corner[0], corner[1], corner[2], 0.f);
      primitive.box.add({point, point});
    }
  });
  return primitives;
}
} // namespace

TriangleTreeData buildTriangleTree(std::vector<TreeTriangle> triangles, int threads)
{
  std::vector<Primitive> primitives = primitivesOf(triangles, threads);
  TriangleTreeData tree;
  tree.nodes = Builder(primitives, threads).build();
  tree.triangles.resize(triangles.size());
  parallelFor(triangles.size(), threads, [&](Index i) {
    const auto slot = static_cast<std::size_t>(i);
    tree.triangles[slot] = triangles[primitives[slot].triangle];
  });
  return tree;
}
} // namespace fresco
