// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <cstring>
#include <fresco/core/export.h>
#include <fresco/core/types.h>
#include <limits>
#include <vector>
namespace fresco {
namespace search {
struct TreeItem;
}

struct Neighbor {
  int index;              ///< column of the point, -1 = none
  float squared_distance; ///< length^2
};

/// Neighbour search in a fixed set of points: a balanced kd-tree over plain arrays. Non-finite points are left out.
/// Exact; where points are equally far, which of them a search of k returns depends on the points alone. Searches may
/// run in parallel.
///
/// The tree keeps its points in its own order, in which near points lie near each other in memory: loops over all
/// points are fastest over positions (0 .. size() - 1), see nearestLists().
class FRESCO_EXPORT PointTree {
public:
  /// @param points 3xN, N up to 2^31 - 1; copied
  explicit PointTree(const Points& points, int threads = 0);

  Index size() const { return columns_.size(); }               ///< finite points
  const std::vector<int>& columns() const { return columns_; } ///< position -> column of `points`
  Eigen::Vector3f point(Index position) const
  {
    const float* leaf = coordinates_.data() + position / leaf_size * 3 * leaf_size + position % leaf_size;
    return {leaf[0], leaf[leaf_size], leaf[2 * leaf_size]};
  }
  Points points() const; ///< 3 x size(), by position

  /// The nearest point closer than `max_distance`; index -1 where there is none or the query is not finite.
  Neighbor nearest(const Eigen::Vector3f& query, float max_distance = std::numeric_limits<float>::infinity()) const;

  /// The k nearest points (fewer if there are fewer), by distance. Nothing for a query that is not finite.
  void nearest(const Eigen::Vector3f& query, int k, std::vector<Neighbor>& found) const;

  /// All points not farther than `radius`, by distance.
  void within(const Eigen::Vector3f& query, float radius, std::vector<Neighbor>& found) const;

  /// For inner loops: distance and position in one number, (bits of squared distance) << 32 | position. Such keys sort
  /// by distance, then position.
  using Key = std::uint64_t;
  static int position(Key key) { return key & 0xffffffffu; }
  static float squaredDistance(Key key)
  {
    const std::uint32_t bits = key >> 32;
    float value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  static Key key(float squared_distance, Index position)
  {
    std::uint32_t bits;
    std::memcpy(&bits, &squared_distance, sizeof bits);
    return Key{bits} << 32 | static_cast<std::uint32_t>(position);
  }

  /// As nearest() with keys in no order.
  /// @param bound no smaller than the squared distance of the k-th neighbour: speeds the search up
  void nearestKeys(const Eigen::Vector3f& query, int k, std::vector<Key>& found,
                   float bound = std::numeric_limits<float>::infinity()) const;

  /// As within() with keys in order of position, or, not sorted, in an order of the tree in which near ones are close.
  void withinKeys(const Eigen::Vector3f& query, float radius, std::vector<Key>& found, bool sorted = true) const;

  /// For searches of many points at once: points are kept in leaves of `leaf_size` positions.
  static constexpr Index leaf_size = 8; ///< points; measured: 8 beats 16 and 32 for k = 16
  Index leafCount() const { return leaves_; }
  const float* leafCoordinates() const { return coordinates_.data(); } ///< per leaf 8 x, 8 y, 8 z; no point: infinity

  /// Leaves that may hold points of the box from `low` to `high`, ascending.
  void leavesWithin(const Eigen::Vector3f& low, const Eigen::Vector3f& high, std::vector<int>& leaves) const;

  /// First leaves of the subtrees of at most `most` leaves, ascending, and leafCount() at the end.
  std::vector<Index> subtrees(Index most) const;

private:
  struct Node {
    float low, high; ///< the left half ends at `low`, the right half begins at `high`
    int axis;
  };
  struct Part;
  struct Box;
  struct OpenPart;
  void build(std::vector<search::TreeItem>& items, int threads);
  void split(std::vector<search::TreeItem>& items, const OpenPart& open, std::vector<OpenPart>& parts);
  template <typename Collector>
  void search(const Eigen::Vector3f& query, Collector& collector) const;

  Index leaves_ = 0;
  std::vector<Node> nodes_;        ///< leaves - 1, in preorder
  std::vector<float> coordinates_; ///< per leaf: all x, all y, all z; the last leaf is filled up with infinity
  std::vector<int> columns_;
};

/// Neighbours of many points: those of point i are index[begin[i]] .. index[begin[i + 1] - 1].
struct NeighborLists {
  std::vector<std::int64_t> begin; ///< N + 1
  std::vector<int> index;

  Index size() const { return begin.size() - 1; }
  Index count(Index i) const { return begin[i + 1] - begin[i]; }
  const int* first(Index i) const { return index.data() + begin[i]; }
  const int* last(Index i) const { return index.data() + begin[i + 1]; }
};

/// The k nearest (fewer if there are fewer) of every point of the tree, itself included, by distance; positions.
FRESCO_EXPORT NeighborLists nearestLists(const PointTree& tree, int k, int threads = 0);
constexpr int fewest_within = 6, most_within = 256; ///< neighbours within a radius that a surface is told by
/// All points within radii[i] of point i, itself included, in order of position. Where there are more than
/// `most` of them, every m-th in the order of the tree, which spreads them evenly; itself stays.
/// @param radii tree.size() or 1 (for all), by position, length, >= 0
FRESCO_EXPORT NeighborLists radiusLists(const PointTree& tree, const Eigen::VectorXf& radii, int most, int threads = 0);

/// The k nearest of every finite point of an image of points among those in a window around its pixel, itself included,
/// by distance; columns. Empty for non-finite points.
/// @param points 3 x (width * height), row by row
FRESCO_EXPORT NeighborLists imageLists(const Points& points, Index width, int k, int threads = 0);
} // namespace fresco
