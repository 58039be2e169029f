// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <fresco/core/require.h>
#include <fresco/search/nearest_grid.h>
namespace fresco {
namespace {
constexpr std::uint64_t no_key = ~std::uint64_t{0};
constexpr int block_bits = 2, block_cells = 64;

using Cell = Eigen::Array<std::int64_t, 3, 1>;

// Not negative for all places that a search looks up, so that rounding towards zero is down.
inline Cell cellAt(const Eigen::Vector3f& place, double per_edge)
{
  return (place.array().cast<double>() * per_edge + (1 << 20)).cast<std::int64_t>();
}

inline std::uint64_t keyOf(const Cell& block)
{
  return static_cast<std::uint64_t>(block[0] << 42 | block[1] << 21 | block[2]);
}

Cell blockOf(std::uint64_t key)
{
  constexpr std::uint64_t mask = (1 << 21) - 1;
  return {static_cast<std::int64_t>(key >> 42), static_cast<std::int64_t>(key >> 21 & mask),
          static_cast<std::int64_t>(key & mask)};
}

// Points that are the nearest to some place of a cell.
class CellPoints {
public:
  CellPoints(const PointTree& tree, float reach, float half_edge)
      : tree_(tree), reach_(reach), half_edge_(half_edge), radius_(std::sqrt(3.f) * half_edge)
  {}

  // Ascending positions.
  const std::vector<std::uint32_t>& find(const Eigen::Vector3f& center)
  {
    kept_.clear();
    positions_.clear();
    const Neighbor nearest = tree_.nearest(center, 1.01f * (reach_ + radius_));
    if (nearest.index < 0)
      return positions_;
    const float least = std::sqrt(nearest.squared_distance);
    tree_.withinKeys(center, std::min(1.0001f * (least + 2.f * radius_), reach_ + radius_), keys_, false);
    std::sort(keys_.begin(), keys_.end());
    for (const PointTree::Key key : keys_) {
      const Eigen::Vector3f place = tree_.point(PointTree::position(key)) - center;
      const float outside = (place.array().abs() - half_edge_).max(0.f).matrix().norm();
      if (outside > reach_ || dominated(place))
        continue;
      kept_.push_back(place);
      positions_.push_back(PointTree::position(key));
    }
    std::sort(positions_.begin(), positions_.end());
    return positions_;
  }

private:
  // Whether another point is nearer to every place of the cell, by the largest difference of squared distances over it.
  bool dominated(const Eigen::Vector3f& place) const
  {
    const float squared = place.squaredNorm();
    return std::any_of(kept_.begin(), kept_.end(), [&](const Eigen::Vector3f& other) {
      return other.squaredNorm() + 2.f * half_edge_ * (other - place).lpNorm<1>() < squared;
    });
  }

  const PointTree& tree_;
  const float reach_, half_edge_, radius_;
  std::vector<PointTree::Key> keys_;
  std::vector<Eigen::Vector3f> kept_; // from the cell's centre, nearest first
  std::vector<std::uint32_t> positions_;
};
} // namespace

NearestGrid::NearestGrid(const PointTree& tree, float reach, float cell)
    : columns_(tree.columns()), reach_(reach), cell_(cell), cells_per_length_(1.0 / cell), shift_(64 - 8),
      table_(1 << 8, {no_key, 0})
{
  require(cell > 0 && reach >= 0 && reach <= 32 * cell, "grid of nearest points: cells of ", cell, " for a reach of ",
          reach);
  coordinates_.reserve(3 * tree.size());
  for (Index i = 0; i < tree.size(); ++i) {
    const Eigen::Vector3f point = tree.point(i);
    coordinates_.insert(coordinates_.end(), point.data(), point.data() + 3);
    farthest_ = std::max(farthest_, point.cwiseAbs().maxCoeff());
  }
  require(farthest_ < most_cells * cell, "grid of nearest points: a point lies ", farthest_ / cell,
          " cells from the origin");
  for (Index i = 0; i < tree.size(); ++i)
    addBlocks(tree.point(i));
  fill(tree);
}

void NearestGrid::fill(const PointTree& tree)
{
  // Rounding must not put a place into a cell that lacks its nearest point.
  const float rounding = 1e-6f * farthest_;
  CellPoints near(tree, reach_ + rounding, 0.501f * cell_ + rounding);
  begin_.reserve(keys_.size() * block_cells + 1);
  for (const std::uint64_t key : keys_) {
    const Cell first = blockOf(key) * (1 << block_bits) - (1 << 20);
    for (int k = 0; k < block_cells; ++k) {
      const Cell at = first + Cell(k >> 4, k >> 2 & 3, k & 3);
      begin_.push_back(static_cast<std::uint32_t>(positions_.size()));
      const auto& found = near.find(cell_ * (at.cast<float>() + 0.5f));
      positions_.insert(positions_.end(), found.begin(), found.end());
    }
  }
  begin_.push_back(static_cast<std::uint32_t>(positions_.size()));
  positions_.shrink_to_fit();
}

// Where the key is or may be put.
inline std::size_t NearestGrid::slot(std::uint64_t key) const
{
  std::size_t i = key * 0x9e3779b97f4a7c15u >> shift_;
  while (table_[i].key != key && table_[i].key != no_key)
    i = (i + 1) & (table_.size() - 1);
  return i;
}

void NearestGrid::addBlocks(const Eigen::Vector3f& point)
{
  const Cell low = cellAt(point.array() - reach_, cells_per_length_) / (1 << block_bits),
             high = cellAt(point.array() + reach_, cells_per_length_) / (1 << block_bits);
  Cell at;
  for (at[0] = low[0]; at[0] <= high[0]; ++at[0])
    for (at[1] = low[1]; at[1] <= high[1]; ++at[1])
      for (at[2] = low[2]; at[2] <= high[2]; ++at[2]) {
        Block& entry = table_[slot(keyOf(at))];
        if (entry.key != no_key)
          continue;
        entry = {keyOf(at), static_cast<std::uint32_t>(keys_.size() * block_cells)};
        keys_.push_back(entry.key);
        if (2 * keys_.size() > table_.size())
          grow();
      }
}

void NearestGrid::grow()
{
  std::vector<Block> old(2 * table_.size(), {no_key, 0});
  old.swap(table_);
  --shift_;
  for (const Block& entry : old)
    if (entry.key != no_key)
      table_[slot(entry.key)] = entry;
}

Neighbor NearestGrid::nearest(const Eigen::Vector3f& query, float max_distance) const
{
  Neighbor best{-1, max_distance * max_distance};
  if (!((query.array().abs() < (most_cells + 48.f) * cell_).all()))
    return best;
  const Cell cell = cellAt(query, cells_per_length_);
  const Block& block = table_[slot(keyOf(cell / (1 << block_bits)))];
  if (block.key == no_key)
    return best;
  const std::int64_t k = block.first + ((cell[0] & 3) << 4 | (cell[1] & 3) << 2 | (cell[2] & 3));
  for (std::uint32_t i = begin_[k]; i < begin_[k + 1]; ++i) {
    const float* p = coordinates_.data() + 3 * static_cast<std::size_t>(positions_[i]);
    const float dx = p[0] - query[0], dy = p[1] - query[1], dz = p[2] - query[2];
    const float squared = dx * dx + dy * dy + dz * dz;
    if (squared < best.squared_distance)
      best = {static_cast<int>(positions_[i]), squared};
  }
  if (best.index >= 0)
    best.index = columns_[best.index];
  return best;
}
} // namespace fresco
