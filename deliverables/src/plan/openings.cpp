// SPDX-License-Identifier: BSD-3-Clause
#include "plan/openings.h"
namespace fresco::plan {
using Eigen::Vector2d;

namespace {
constexpr double wall_band = 0.02;  // metres from the line that are the wall; closed doors lie deeper
constexpr double before = 0.8;      // metres before the wall where furniture hides it
constexpr double least_width = 0.4; // metres of a window
constexpr double cut_band = 0.1;    // metres about the height of the cut

/// A wall from the front: cells where its surface was seen, and whether something stands before it at the cut.
class Elevation {
public:
  Elevation(const PlanWall& wall, double floor, const OpeningInput& input)
      : from_(wall.from), along_((wall.to - wall.from).normalized()), floor_(floor), cut_(input.storey.height - floor),
        column_(std::max(0.02, input.cell)), row_(std::max(section_pitch, 2 * input.cell))
  {
    columns_ = static_cast<int>((wall.to - wall.from).norm() / column_);
    rows_ = static_cast<int>((input.storey.ceiling - floor) / row_) + 1;
    seen_.assign(static_cast<std::size_t>(std::max(0, columns_)) * rows_, false);
    at_cut_.assign(std::max(0, columns_), false);
    hidden_ = at_cut_;
    const Vector2d left(-along_.y(), along_.x());
    input.upright.near(wall.from, wall.to, before, [&](const Eigen::Vector3f& p) {
      const Vector2d offset = p.head<2>().cast<double>() - from_;
      add(static_cast<int>(std::floor(along_.dot(offset) / column_)), left.dot(offset), p.z() - floor_);
    });
    closeSpecks();
  }

  std::vector<PlanOpening> openings() const
  {
    std::vector<PlanOpening> found;
    for (int begin = 0; begin < columns_; ++begin) {
      int end = begin;
      while (end < columns_ && !at_cut_[end])
        ++end;
      if ((end - begin) * column_ >= least_width &&
          2 * std::count(hidden_.begin() + begin, hidden_.begin() + end, true) < end - begin)
        addOpening(begin, end, found);
      begin = end;
    }
    return found;
  }

private:
  void add(int column, double inwards, double height)
  {
    if (column < 0 || column >= columns_ || inwards < -wall_band || inwards > before)
      return;
    const bool near_cut = std::abs(height - cut_) <= std::max(cut_band, row_);
    if (inwards > wall_band) {
      hidden_[column] = hidden_[column] || near_cut;
      return;
    }
    at_cut_[column] = at_cut_[column] || near_cut;
    const int row = static_cast<int>(std::floor(height / row_));
    if (row >= 0 && row < rows_)
      seen_[static_cast<std::size_t>(row) * columns_ + column] = true;
  }

  /// Single columns within an opening: a handle, a stray point.
  void closeSpecks()
  {
    const int speck = std::max(1, static_cast<int>(0.06 / column_));
    for (int begin = 0; begin < columns_; ++begin) {
      int end = begin;
      while (end < columns_ && at_cut_[end])
        ++end;
      if (begin > 0 && end < columns_ && end > begin && end - begin <= speck)
        std::fill(at_cut_.begin() + begin, at_cut_.begin() + end, false);
      begin = std::max(begin, end);
    }
  }

  bool isOpen(int row, int begin, int end) const
  {
    const auto first = seen_.begin() + static_cast<std::ptrdiff_t>(row) * columns_;
    return 10 * std::count(first + begin, first + end, true) < 3 * (end - begin);
  }

  /// Whether the surface was seen on all sides of a hole, in most of the blocks of 10 cm around it; not below a door.
  bool isFramed(int begin, int end, int low, int high) const
  {
    const int block = std::max(1, static_cast<int>(0.1 / column_)), rows = high - low + 1;
    const auto any = [&](int row, int first, int last) {
      const auto at = seen_.begin() + static_cast<std::ptrdiff_t>(row) * columns_;
      return std::find(at + first, at + last, true) != at + last;
    };
    if (begin < block || end + block > columns_ || high + 2 >= rows_)
      return false;
    int left = 0, right = 0, above = 0, below = 0, across = 0;
    for (int row = low; row <= high; ++row) {
      left += any(row, begin - block, begin);
      right += any(row, end, end + block);
    }
    for (int column = begin; column + block <= end; column += block, ++across) {
      above += any(high + 1, column, column + block) || any(high + 2, column, column + block);
      below += low < 2 || any(low - 1, column, column + block) || any(low - 2, column, column + block);
    }
    return 10 * std::min(left, right) >= 6 * rows && 10 * std::min(above, below) >= 6 * across;
  }

  /// A hole with straight sides. What a scanner did not see has other shapes.
  void addOpening(int begin, int end, std::vector<PlanOpening>& found) const
  {
    int low = std::clamp(static_cast<int>(cut_ / row_), 0, rows_ - 1), high = low;
    while (low > 0 && isOpen(low - 1, begin, end))
      --low;
    while (high + 1 < rows_ && isOpen(high + 1, begin, end))
      ++high;
    if (!isFramed(begin, end, low, high))
      return;
    PlanOpening out;
    out.from = from_ + begin * column_ * along_;
    out.to = from_ + end * column_ * along_;
    out.is_door = low * row_ < 0.09; // the row at the floor may hold the floor itself
    out.sill = out.is_door ? 0 : low * row_;
    out.head = (high + 1) * row_;
    found.push_back(out);
  }

  Vector2d from_, along_;
  double floor_, cut_, column_, row_;
  int columns_ = 0, rows_ = 0;
  std::vector<bool> seen_, at_cut_, hidden_;
};
} // namespace

std::vector<PlanOpening> findOpenings(const PlanWall& wall, double floor, const OpeningInput& input)
{
  constexpr double deepest = 0.6; // metres of a wall between two rooms
  const Vector2d along = (wall.to - wall.from).normalized(), outwards(along.y(), -along.x());
  const Grid& grid = input.regions.grid;
  std::vector<PlanOpening> found = Elevation(wall, floor, input).openings();
  for (PlanOpening& opening : found)
    for (double d = 0.05; d < deepest && opening.beyond < 0; d += grid.cell) {
      const Vector2d p = (opening.from + opening.to) / 2 + d * outwards;
      if (const Index at = grid.at(p.x(), p.y()); at >= 0)
        opening.beyond = input.regions.labels[at];
    }
  return found;
}
} // namespace fresco::plan
