// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/samples/occupied_cells.h"
#include "poisson/octree/select.h"
#include <algorithm>
#include <fresco/core/require.h>
#include <limits>
namespace fresco::poisson {
namespace {
using Iterator = Array<OccupiedBrick>::const_iterator;

struct Range {
  Iterator begin, end;
};

/// put(brick) for the bricks of either range, rising.
template <typename Put>
void merge(Range a, Range b, const Put& put)
{
  while (a.begin != a.end && b.begin != b.end)
    if (a.begin->code < b.begin->code) {
      put(*a.begin++);
    } else if (b.begin->code < a.begin->code) {
      put(*b.begin++);
    } else {
      put({a.begin->code, a.begin->cells | b.begin->cells});
      ++a.begin;
      ++b.begin;
    }
  std::for_each(a.begin, a.end, put);
  std::for_each(b.begin, b.end, put);
}
} // namespace

Array<OccupiedBrick> unite(const Array<OccupiedBrick>& a, const Array<OccupiedBrick>& b, int threads)
{
  constexpr Index parts = 256;
  const Array<OccupiedBrick>& larger = a.size() < b.size() ? b : a;
  const auto cut = [&](const Array<OccupiedBrick>& bricks, Index part) {
    const auto before = [](const OccupiedBrick& brick, std::uint64_t code) { return brick.code < code; };
    if (part == 0 || part == parts)
      return part == 0 ? bricks.begin() : bricks.end();
    return std::lower_bound(bricks.begin(), bricks.end(), larger[larger.size() * part / parts].code, before);
  };
  const auto mergePart = [&](Index part, const auto& put) {
    merge({cut(a, part), cut(a, part + 1)}, {cut(b, part), cut(b, part + 1)}, put);
  };
  if (larger.empty())
    return {};
  std::vector<Index> first(parts + 1, 0);
  parallelFor(parts, threads, [&](Index p) { mergePart(p, [&](const OccupiedBrick&) { ++first[p + 1]; }); });
  for (Index p = 0; p < parts; ++p)
    first[p + 1] += first[p];
  Array<OccupiedBrick> result(first[parts]);
  parallelFor(parts, threads, [&](Index p) {
    OccupiedBrick* to = result.data() + first[p];
    mergePart(p, [&](const OccupiedBrick& brick) { *to++ = brick; });
  });
  return result;
}

void OccupiedCells::add(const SortedPoints& points, int threads)
{
  if (points.size() == 0)
    return;
  const Array<std::uint32_t> runs = runBegins(points.size(), threads, [&](Index k) { return points.code(k) >> 6; });
  Array<OccupiedBrick> bricks(runs.size() - 1);
  parallelFor(bricks.size(), threads, [&](Index b) {
    bricks[b] = {points.code(runs[b]) >> 6, 0};
    for (std::uint32_t k = runs[b]; k < runs[b + 1]; ++k)
      bricks[b].cells |= std::uint64_t(1) << (points.code(k) & 63);
  });
  bricks_ = bricks_.empty() ? std::move(bricks) : unite(bricks_, bricks, threads);
}

OccupiedCells findCells(const PointStream& points, const Extent& extent, int threads)
{
  OccupiedCells cells;
  forEachPiece(points, extent, threads, [&](const SortedPoints& sorted) { cells.add(sorted, threads); });
  return cells;
}

Index OccupiedCells::count() const
{
  Index cells = 0;
  for (const OccupiedBrick& brick : bricks_)
    cells += __builtin_popcountll(brick.cells);
  return cells;
}

Array<std::uint32_t> OccupiedCells::firstCells() const
{
  const Index cells = count();
  require(cells <= Index(std::numeric_limits<std::uint32_t>::max()), "volumetric reconstruction: points lie in ", cells,
          " cells, more than 2^32 - 1: choose a smaller depth");
  Array<std::uint32_t> first(bricks_.size() + 1);
  std::uint32_t at = 0;
  for (std::size_t b = 0; b < bricks_.size(); at += __builtin_popcountll(bricks_[b++].cells))
    first[b] = at;
  first.back() = at;
  return first;
}

Array<std::uint64_t> OccupiedCells::codes(int threads) const
{
  const Array<std::uint32_t> first = firstCells();
  Array<std::uint64_t> codes(first.back());
  parallelFor(bricks_.size(), threads, [&](Index b) {
    std::uint64_t* to = codes.data() + first[b];
    for (std::uint64_t left = bricks_[b].cells; left != 0; left &= left - 1)
      *to++ = bricks_[b].code << 6 | std::uint64_t(__builtin_ctzll(left));
  });
  return codes;
}
} // namespace fresco::poisson
