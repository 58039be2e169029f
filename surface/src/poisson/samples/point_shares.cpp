// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/samples/point_shares.h"
#include "poisson/octree/bytes.h"
#include "poisson/samples/cell_sums.h"
#include <fresco/core/require.h>
namespace fresco::poisson {
namespace {
Partition choosePartition(const OccupiedCells& cells, int depth, const RankOptions& ranks, Exchange& exchange)
{
  constexpr std::int64_t brick_load = 20; // in samples, by bytes and by time
  const std::uint64_t atoms = Partition::atomCount(ranks.shared_depth);
  std::vector<std::uint64_t> first_atoms(exchange.size(), atoms);
  first_atoms[0] = 0;
  if (!isDivided(depth, ranks))
    return Partition(exchange, ranks.shared_depth, first_atoms);
  if (!ranks.first_atoms.empty())
    return Partition(exchange, ranks.shared_depth, ranks.first_atoms);
  std::vector<std::int64_t> load(atoms, 0);
  for (const OccupiedBrick& brick : cells.bricks())
    load[brick.code >> 3 * (depth - 2 - Partition::atomDepth(ranks.shared_depth))] +=
        brick_load + __builtin_popcountll(brick.cells);
  exchange.sum(load.data(), load.size());
  return Partition(exchange, ranks.shared_depth, Partition::evenly(load, exchange.size()));
}

/// To each rank those of the bricks, sorted by code, that are in its atoms.
OccupiedCells ownCells(const OccupiedCells& cells, int depth, const Partition& partition, int threads)
{
  const Array<OccupiedBrick>& bricks = cells.bricks();
  std::vector<Bytes> to(partition.ranks());
  const auto isBefore = [](const OccupiedBrick& brick, std::uint64_t code) { return brick.code < code; };
  for (int r = 0; r < partition.ranks(); ++r) {
    const auto [first, last] = partition.codesOf(r, depth - 2);
    const auto begin = std::lower_bound(bricks.begin(), bricks.end(), first, isBefore);
    const auto end = std::lower_bound(begin, bricks.end(), last, isBefore);
    append(to[r], bricks.data() + (begin - bricks.begin()), end - begin);
  }
  Array<OccupiedBrick> own;
  for (Bytes& part : partition.exchange().deliver(std::move(to))) {
    own = unite(own, valuesOf<OccupiedBrick>(part), threads);
    Bytes().swap(part);
  }
  return OccupiedCells(std::move(own));
}

/// Sums of the cells of a piece of the points, sent to the ranks that have the cells. All ranks take part until none has
/// points left.
class CellDelivery {
public:
  CellDelivery(const Extent& extent, const Partition& partition, CellSums& sums, int threads)
      : depth_(extent.cube.depth), partition_(partition), points_(extent), sums_(sums), threads_(threads)
  {}

  void deliver(const SortedPoints& piece)
  {
    constexpr std::size_t cells_at_a_time = 1 << 17; // 12 MB of sums
    const Array<std::uint32_t> begins = cellBegins(piece, threads_);
    for (std::size_t first = 0; first + 1 < begins.size(); first += cells_at_a_time) {
      std::vector<Bytes> to(partition_.ranks());
      for (std::size_t c = first; c < std::min(first + cells_at_a_time, begins.size() - 1); ++c) {
        Entry entry = {piece.code(begins[c]), {}, {}};
        points_.add(piece, begins[c], begins[c + 1], entry.sum);
        if (points_.hasAttributes())
          points_.addAttributes(piece, begins[c], begins[c + 1], entry.attributes);
        append(to[partition_.ownerOf(depth_, entry.code)], entry);
      }
      exchange(1, std::move(to));
    }
  }

  void finish()
  {
    while (exchange(0, std::vector<Bytes>(partition_.ranks())) > 0) {
    }
  }

private:
  struct Entry {
    std::uint64_t code;
    CellSum sum;
    AttributeSum attributes;
  };

  /// @return ranks that still had something
  std::int64_t exchange(std::int64_t has_points, std::vector<Bytes> to)
  {
    const std::int64_t active = sumOfAll(partition_.exchange(), has_points);
    if (active > 0)
      for (const Bytes& part : partition_.exchange().deliver(std::move(to)))
        for (const Entry& entry : valuesOf<Entry>(part))
          sums_.add(entry.code, entry.sum, entry.attributes);
    return active;
  }

  int depth_;
  const Partition& partition_;
  PointSums points_;
  CellSums& sums_;
  int threads_;
};
} // namespace

SampleShare gatherShare(const PointStream& points, const VolumetricOptions& options, const RankOptions& ranks,
                        Exchange& exchange)
{
  const int threads = options.threads;
  const Extent extent = findExtent(points, options, exchange);
  const int depth = extent.cube.depth;
  OccupiedCells cells = findCells(points, extent, threads);
  const Partition partition = choosePartition(cells, depth, ranks, exchange);
  cells = ownCells(cells, depth, partition, threads);
  CellSums sums(std::move(cells), extent, threads);
  CellDelivery delivery(extent, partition, sums, threads);
  forEachPiece(points, extent, threads, [&](const SortedPoints& piece) { delivery.deliver(piece); });
  delivery.finish();
  return {partition, sums.takeSamples(threads)};
}
} // namespace fresco::poisson
