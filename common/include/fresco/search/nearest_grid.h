// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <fresco/search/neighbors.h>
namespace fresco {
/// Nearest neighbours within a short reach, for many searches in a fixed set of points: a hash table of cells, each with
/// all points that are the nearest to some place in it. A search looks at one cell: some four points where cells are as
/// wide as points lie apart. Exact; which of points equally near is found depends on the points alone. Searches may run
/// in parallel.
///
/// With a reach of two cells, points of a surface take 300 bytes and 20 to 40 microseconds each to build: worth it from
/// hundreds of searches a point on. @see PointTree for any reach
class FRESCO_EXPORT NearestGrid {
public:
  /// Farthest coordinates in `points`, in cells.
  static constexpr float most_cells = (1 << 20) - 64;

  /// @param tree  the points; not needed later
  /// @param reach farthest neighbours that can be found, length, up to 32 cells
  /// @param cell  edge, length
  /// @throws std::invalid_argument if the points reach farther than `most_cells` from the origin
  NearestGrid(const PointTree& tree, float reach, float cell);

  float reach() const { return reach_; }
  Index size() const { return positions_.size(); } ///< points in all cells

  /// The nearest point closer than `max_distance`, which is at most reach(); index -1 where there is none or the query
  /// is not finite.
  Neighbor nearest(const Eigen::Vector3f& query, float max_distance) const;

private:
  /// 4 x 4 x 4 cells: few blocks and small tables stay in the cache.
  struct Block {
    std::uint64_t key;
    std::uint32_t first; ///< of its cells in begin_
  };
  std::size_t slot(std::uint64_t key) const;
  void addBlocks(const Eigen::Vector3f& point);
  void grow();
  void fill(const PointTree& tree);

  std::vector<float> coordinates_; ///< x, y, z of each point by position in the tree: near ones lie near each other
  std::vector<int> columns_;       ///< of each position
  float reach_, cell_, farthest_ = 0.f;
  double cells_per_length_;
  int shift_;                            ///< 64 - log2 of the table's size
  std::vector<std::uint64_t> keys_;      ///< of all blocks
  std::vector<Block> table_;             ///< open addressing, a power of two, at most half full
  std::vector<std::uint32_t> begin_;     ///< of each cell in positions_, and the end
  std::vector<std::uint32_t> positions_; ///< ascending in each cell
};
} // namespace fresco
