// SPDX-License-Identifier: BSD-3-Clause
#include "charts/atlas_packing.h"
#include "photographs/grid.h"
#include <algorithm>
#include <boost/dynamic_bitset.hpp>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <stdexcept>
namespace fresco::texture {
namespace {
constexpr int tries = 5; // of sides: more hardly save a texel

using BitRow = boost::dynamic_bitset<std::uint64_t>;

struct Run {
  int begin, length;
};

/// Outline of a chart on a grid of blocks: the runs of blocks it needs in each row.
struct Mask {
  int width = 0, height = 0;
  std::vector<std::vector<Run>> rows;
  std::vector<int> blocks; ///< of each row
};

Mask maskOf(const Chart& chart, int block)
{
  Mask mask;
  mask.width = (chart.width + block - 1) / block;
  mask.height = (chart.height + block - 1) / block;
  std::vector<char> taken(cellCount(mask.width, mask.height), 0);
  for (const TexelSpan& span : chart.texels.spans)
    for (int x = span.x / block; x <= (span.x + span.length - 1) / block; ++x)
      taken[cellAt(x, span.y / block, mask.width)] = 1;
  mask.rows.resize(mask.height);
  mask.blocks.assign(mask.height, 0);
  for (int y = 0; y < mask.height; ++y) {
    const char* row = taken.data() + cellAt(0, y, mask.width);
    for (int x = 0, end = 0; x < mask.width; x = end + 1) {
      for (end = x; end < mask.width && row[end]; ++end)
        ;
      if (end > x)
        mask.rows[y].push_back({x, end - x});
      mask.blocks[y] += end - x;
    }
  }
  return mask;
}

/// Bit x of the result: whether any of the bits x .. x + length - 1 is set.
BitRow anyOf(BitRow row, int length)
{
  for (int have = 1; have < length;) {
    const int step = std::min(have, length - have);
    row |= row >> step;
    have += step;
  }
  return row;
}

/// A grid of blocks of fixed width.
class Grid {
public:
  /// @param height 0 = unlimited
  Grid(int width, int height) : width_(width), height_(height) {}

  /// First free place from row `from` on, rows first. @return false if there is none
  bool find(const Mask& mask, int from, Eigen::Vector2i& place)
  {
    if (mask.width > width_)
      return false;
    for (int y = from; height_ == 0 || y + mask.height <= height_; ++y) {
      while (Index(rows_.size()) < y + mask.height)
        rows_.emplace_back(width_);
      free_.resize(rows_.size(), width_);
      if (const int x = firstFree(mask, y); x >= 0) {
        place = {x, y};
        return true;
      }
    }
    return false;
  }

  void take(const Mask& mask, const Eigen::Vector2i& place)
  {
    for (int j = 0; j < mask.height; ++j) {
      for (const Run& run : mask.rows[j])
        rows_[place.y() + j].set(place.x() + run.begin, run.length, true);
      free_[place.y() + j] -= mask.blocks[j];
    }
    top_ = std::max(top_, place.y() + mask.height);
  }

  int top() const { return top_; } ///< rows in use

private:
  int firstFree(const Mask& mask, int y) const
  {
    for (int j = 0; j < mask.height; ++j)
      if (mask.blocks[j] > free_[y + j])
        return -1;
    BitRow taken(width_);
    taken.set(width_ - mask.width + 1, mask.width - 1, true);
    for (int j = 0; j < mask.height && !taken.all(); ++j)
      for (const Run& run : mask.rows[j])
        taken |= anyOf(rows_[y + j], run.length) >> run.begin;
    const std::size_t free = (~taken).find_first();
    return free == BitRow::npos ? -1 : int(free);
  }

  int width_, height_, top_ = 0;
  std::vector<BitRow> rows_; ///< blocks that are taken
  std::vector<int> free_;    ///< blocks of each row that are not
};

int logSize(int length) { return std::lround(2 * std::log2(length)); }

class Packer {
public:
  Packer(std::vector<Chart>& charts, int block) : charts_(charts), block_(block), order_(charts.size())
  {
    for (const Chart& chart : charts)
      masks_.push_back(maskOf(chart, block));
    std::iota(order_.begin(), order_.end(), 0);
    const auto size = [&](int c) { return cellCount(masks_[c].width, masks_[c].height); };
    std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) { return size(a) > size(b); });
  }

  /// Places all charts. @return rows used of the last grid, in blocks
  int pack(int width, int height)
  {
    grids_.clear();
    hints_.clear();
    for (const int c : order_)
      place(c, width, height);
    return grids_.empty() ? 0 : grids_.back().top();
  }

  int atlases() const { return grids_.size(); }

private:
  void place(int c, int width, int height)
  {
    const Mask& mask = masks_[c];
    const std::pair<int, int> size(logSize(mask.width), logSize(mask.height));
    for (std::size_t g = 0;; ++g) {
      if (g == grids_.size()) {
        grids_.emplace_back(width, height);
        hints_.emplace_back();
      }
      int& from = hints_[g][size]; // above this row a chart of about this size found no place
      Eigen::Vector2i at;
      if (!grids_[g].find(mask, from, at)) {
        if (grids_[g].top() == 0)
          throw std::logic_error("texture: a chart is larger than its atlas");
        from = height;
        continue;
      }
      from = at.y();
      grids_[g].take(mask, at);
      charts_[c].atlas = g;
      charts_[c].x = at.x() * block_;
      charts_[c].y = at.y() * block_;
      return;
    }
  }

  std::vector<Chart>& charts_;
  int block_;
  std::vector<int> order_;
  std::vector<Mask> masks_;
  std::vector<Grid> grids_;
  std::vector<std::map<std::pair<int, int>, int>> hints_; ///< per grid
};

double ownedTexels(const std::vector<Chart>& charts)
{
  double sum = 0;
  for (const Chart& chart : charts)
    sum += chart.texels.count();
  return sum;
}

/// Width of the smallest square that `packer` fills, blocks.
int smallestSquare(Packer& packer, int least, double blocks)
{
  int width = std::max<int>(least, std::ceil(std::sqrt(blocks / 0.9))), best = 0, best_width = width, packed = 0;
  for (int i = 0; i < tries; ++i) {
    packed = width;
    const int height = packer.pack(width, 0), side = std::max(width, height);
    if (best == 0 || side < best) {
      best = side;
      best_width = width;
    }
    if (std::abs(height - width) <= 1 + width / 100)
      break;
    width = std::max(least, (width + height + 1) / 2);
  }
  if (packed != best_width)
    packer.pack(best_width, 0);
  return best;
}

/// Side of the smallest squares, as few as possible, that `packer` fills; blocks.
int smallestSquares(Packer& packer, int least, int largest)
{
  packer.pack(largest, largest);
  const int count = packer.atlases();
  int low = least, high = largest; // high is enough
  for (int i = 0; i < tries && high - low > high / 64; ++i) {
    const int middle = (low + high) / 2;
    packer.pack(middle, middle);
    (packer.atlases() <= count ? high : low) = middle;
  }
  packer.pack(high, high);
  return high;
}
} // namespace

Packing packCharts(std::vector<Chart>& charts, int largest)
{
  constexpr double most_blocks = 1024; // along a side
  const double owned = ownedTexels(charts);
  const double guess = std::min<double>(largest, std::sqrt(owned / 0.8));
  int block = 1;
  while (guess / block > most_blocks)
    block *= 2;
  Packer packer(charts, block);
  Packing out;
  int widest = 1;
  for (const Chart& chart : charts)
    widest = std::max({widest, (chart.width + block - 1) / block, (chart.height + block - 1) / block});
  if (owned <= 1.0 * largest * largest)
    out.side = block * smallestSquare(packer, widest, owned / block / block);
  if (out.side == 0 || out.side > largest)
    out.side = block * smallestSquares(packer, widest, largest / block);
  out.atlases = std::max(1, packer.atlases());
  out.used = owned / (1.0 * out.side * out.side * out.atlases);
  return out;
}
} // namespace fresco::texture
