// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/octree/bytes.h"
#include "poisson/octree/ghost_finder.h"
#include "poisson/octree/node_field.h"
#include "poisson/octree/radix_sort.h"
#include "poisson/octree/select.h"
#include <algorithm>
#include <fresco/core/machine_memory.h>
#include <fresco/core/morton.h>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <limits>
namespace fresco::poisson {
namespace {
/// A brick with the cells of it that hold samples, in Morton order.
struct Occupied {
  std::uint64_t code, cells;
};

using Masks = std::array<std::uint64_t, 27>;

/// By offsetIndex(): the cells of a brick whose one-cell neighbourhood reaches the brick at that offset.
Masks touchMasks()
{
  Masks masks{};
  const auto reaches = [](int cell, int d) { return d == 0 || cell == (d < 0 ? 0 : brick_cells - 1); };
  for (int o = 0; o < 27; ++o)
    for (std::uint64_t cell = 0; cell < 64; ++cell) {
      const auto [x, y, z] = mortonCell(cell);
      if (reaches(x, o % 3 - 1) && reaches(y, o / 3 % 3 - 1) && reaches(z, o / 9 - 1))
        masks[o] |= std::uint64_t(1) << cell;
    }
  return masks;
}

/// Bricks of n entries in Morton order. @param brick_of code of an entry's brick. @param cells_of cells that it adds
template <typename BrickOf, typename CellsOf>
Array<Occupied> joinEntries(Index n, int threads, const BrickOf& brick_of, const CellsOf& cells_of)
{
  const Array<std::uint32_t> runs = runBegins(n, threads, brick_of);
  Array<Occupied> bricks(runs.size() - 1);
  parallelFor(bricks.size(), threads, [&](Index b) {
    bricks[b] = {brick_of(runs[b]), 0};
    for (std::uint32_t i = runs[b]; i < runs[b + 1]; ++i)
      bricks[b].cells |= cells_of(i);
  });
  return bricks;
}

Array<Occupied> occupiedBricks(const Array<std::uint64_t>& cell_codes, int threads)
{
  return joinEntries(
      cell_codes.size(), threads, [&](Index i) { return cell_codes[i] >> 6; },
      [&](Index i) { return std::uint64_t(1) << (cell_codes[i] & 63); });
}

/// The same one depth coarser.
Array<Occupied> coarsen(const Array<Occupied>& fine, int threads)
{
  return joinEntries(
      fine.size(), threads, [&](Index i) { return fine[i].code >> 3; },
      [&](Index i) {
        std::uint64_t cells = 0;
        for (int g = 0; g < 8; ++g)
          if (fine[i].cells >> (8 * g) & 0xff)
            cells |= std::uint64_t(1) << ((fine[i].code & 7) * 8 + g);
        return cells;
      });
}

/// Codes of all bricks with a cell next to one of the occupied bricks begin .. end - 1, sorted.
std::vector<std::uint64_t> bricksAround(const Array<Occupied>& bricks, Index begin, Index end, int depth)
{
  static const Masks masks = touchMasks();
  const int side = 1 << (depth - 2);
  std::vector<std::uint64_t> codes;
  for (Index i = begin; i < end; ++i) {
    const auto [x, y, z] = mortonCell(bricks[i].code);
    for (int o = 0; o < 27; ++o) {
      const int nx = x + o % 3 - 1, ny = y + o / 3 % 3 - 1, nz = z + o / 9 - 1;
      if ((bricks[i].cells & masks[o]) != 0 && std::min({nx, ny, nz}) >= 0 && std::max({nx, ny, nz}) < side)
        codes.push_back(mortonCode(nx, ny, nz));
    }
  }
  std::sort(codes.begin(), codes.end());
  codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
  return codes;
}

/// Sorted codes of all bricks with a cell next to an occupied one.
std::vector<std::uint64_t> dilate(const Array<Occupied>& bricks, int depth, int threads)
{
  std::vector<std::vector<std::uint64_t>> parts((bricks.size() + chunk_size - 1) / chunk_size);
  parallelRanges(
      bricks.size(), threads,
      [&](Index begin, Index end) { parts[begin / chunk_size] = bricksAround(bricks, begin, end, depth); }, chunk_size);
  std::vector<std::size_t> first(1, 0);
  for (const auto& part : parts)
    first.push_back(first.back() + part.size());
  Array<std::uint64_t> all(first.back());
  parallelFor(parts.size(), threads, [&](Index p) {
    std::copy(parts[p].begin(), parts[p].end(), all.begin() + first[p]);
    releaseMemory(parts[p]);
  });
  sortBits(all, 0, 3 * (depth - 2), threads);
  const Array<std::uint32_t> unique = runBegins(all.size(), threads, [&](Index i) { return all[i]; });
  std::vector<std::uint64_t> codes(unique.size() - 1);
  parallelFor(codes.size(), threads, [&](Index i) { codes[i] = all[unique[i]]; });
  return codes;
}

std::vector<std::uint64_t> allBricks(int depth)
{
  std::vector<std::uint64_t> codes(std::size_t(1) << (3 * (depth - 2)));
  for (std::size_t i = 0; i < codes.size(); ++i)
    codes[i] = i;
  return codes;
}

void linkToParents(BrickLevel& coarse, BrickLevel& fine, int threads)
{
  fine.parents.resize(fine.codes.size());
  coarse.first_children.resize(coarse.codes.size());
  parallelRanges(coarse.size(), threads, [&](Index begin, Index end) {
    const auto first = std::lower_bound(fine.codes.begin(), fine.codes.end(), coarse.codes[begin] << 3);
    Index child = first - fine.codes.begin();
    for (Index p = begin; p < end; ++p) {
      coarse.first_children[p] = child;
      for (; child < fine.size() && fine.codes[child] >> 3 == coarse.codes[p]; ++child) {
        fine.parents[child] = p;
        coarse.child_octants[p] |= 1 << fine.octant(child);
      }
    }
  });
}

/// Where a child looks for its neighbours among the children of one neighbour of its parent.
struct Cousins {
  int uncle = 0; ///< offsetIndex() from the parent
  int count = 0;
  std::array<std::uint8_t, 8> octant{}, offset{}; ///< of that neighbour, from the child
};

/// By the octant of the child.
using CousinTable = std::array<std::array<Cousins, 8>, 8>;

constexpr CousinTable cousinTable()
{
  CousinTable table{};
  for (int octant = 0; octant < 8; ++octant)
    for (int o = 0; o < 27; ++o) {
      const int x = (octant & 1) + o % 3 - 1, y = (octant >> 1 & 1) + o / 3 % 3 - 1, z = (octant >> 2) + o / 9 - 1;
      const int beyond = ((x & ~1) != 0 ? 1 : 0) | ((y & ~1) != 0 ? 2 : 0) | ((z & ~1) != 0 ? 4 : 0);
      Cousins& cousins = table[octant][beyond];
      cousins.uncle = offsetIndex(x >> 1, y >> 1, z >> 1);
      cousins.octant[cousins.count] = static_cast<std::uint8_t>((x & 1) | (y & 1) << 1 | (z & 1) << 2);
      cousins.offset[cousins.count++] = static_cast<std::uint8_t>(o);
    }
  return table;
}

constexpr CousinTable cousin_table = cousinTable();

void linkLevel(Octree& tree, int depth, int threads)
{
  BrickLevel& level = tree.levels[depth];
  level.child_octants.assign(level.codes.size(), 0);
  const Array<std::uint32_t> blocks = runBegins(level.size(), threads, [&](Index b) { return level.codes[b] >> 6; });
  for (std::size_t i = 0; i + 1 < blocks.size(); ++i)
    level.colors[level.codes[blocks[i]] >> 6 & 7].push_back({int(blocks[i]), int(blocks[i + 1])});
  if (depth == 2) {
    level.parents.assign(1, -1);
    level.neighbors.resize(1);
    level.neighbors[0].fill(-1);
    level.neighbors[0][offset_self] = 0;
  } else {
    BrickLevel& coarse = tree.levels[depth - 1];
    level.coarser = &coarse;
    linkToParents(coarse, level, threads);
    if (depth < tree.depth) {
      Array<Neighbors> found(level.codes.size());
      parallelFor(level.size(), threads, [&](Index b) { found[b] = level.neighborsByParent(b); });
      level.neighbors.swap(found);
    }
  }
  findRims(level, threads);
}
} // namespace

Neighbors BrickLevel::neighborsByParent(Index b) const
{
  Neighbors found;
  const int parent = parents[b];
  for (const Cousins& cousins : cousin_table[octant(b)]) {
    const int uncle = coarser->neighbors[parent][cousins.uncle];
    const unsigned octants = uncle < 0 ? 0 : coarser->child_octants[uncle];
    const int first = uncle < 0 ? 0 : coarser->first_children[uncle];
    for (int i = 0; i < cousins.count; ++i) {
      const unsigned bit = 1u << cousins.octant[i];
      found[cousins.offset[i]] = octants & bit ? first + bitCount(octants & (bit - 1)) : -1;
    }
  }
  return found;
}

int BrickLevel::neighborByParent(Index b, int offset) const
{
  const int o = octant(b);
  const int x = (o & 1) + offset % 3 - 1, y = (o >> 1 & 1) + offset / 3 % 3 - 1, z = (o >> 2) + offset / 9 - 1;
  const int uncle = coarser->neighbors[parents[b]][offsetIndex(x >> 1, y >> 1, z >> 1)];
  return uncle < 0 ? -1 : coarser->child(uncle, (x & 1) | (y & 1) << 1 | (z & 1) << 2);
}

Exchange& onlyRank()
{
  static Exchange alone;
  return alone;
}

std::array<int, 3> BrickLevel::corner(Index b) const
{
  const auto [x, y, z] = mortonCell(codes[b]);
  return {x * brick_cells, y * brick_cells, z * brick_cells};
}

Eigen::Vector3f BrickLevel::origin(Index b) const
{
  const std::array<int, 3> c = corner(b);
  return Eigen::Vector3i(c[0], c[1], c[2]).cast<float>();
}

Octree linkBricks(std::vector<std::vector<std::uint64_t>> codes, int full_depth, int threads)
{
  Octree tree;
  tree.depth = codes.size() - 1;
  tree.full_depth = full_depth;
  tree.levels.resize(codes.size());
  for (int d = 2; d <= tree.depth; ++d) {
    tree.levels[d].depth = d;
    require(codes[d].size() <= std::size_t(std::numeric_limits<int>::max()),
            "volumetric reconstruction: ", codes[d].size(), " bricks of depth ", d,
            " are more than 2^31 - 1: choose a smaller depth");
    tree.levels[d].codes = std::move(codes[d]);
    linkLevel(tree, d, threads);
  }
  return tree;
}

Octree buildOctree(const Array<std::uint64_t>& cell_codes, int depth, int full_depth, int threads,
                   const Partition* partition)
{
  std::vector<std::vector<std::uint64_t>> codes(depth + 1);
  GhostFinder ghosts(partition, depth);
  Array<Occupied> occupied = occupiedBricks(cell_codes, threads);
  for (int d = depth; d >= 2; --d) {
    if (partition && d == partition->sharedDepth())
      occupied = gatherAll(partition->exchange(), occupied.data(), occupied.size());
    codes[d] = d <= full_depth ? allBricks(d) : dilate(occupied, d, threads);
    ghosts.exchangeBricks(d, codes[d]);
    occupied = coarsen(occupied, threads);
  }
  Octree tree = linkBricks(std::move(codes), full_depth, threads);
  ghosts.addTo(tree);
  return tree;
}

std::vector<Index> countBricks(const Array<std::uint64_t>& cell_codes, int depth, int full_depth, int threads)
{
  std::vector<Index> counts(depth + 1, 0);
  Array<Occupied> occupied = occupiedBricks(cell_codes, threads);
  for (int d = depth; d >= 2; --d) {
    if (d <= full_depth)
      counts[d] = Index(1) << (3 * (d - 2));
    else
      counts[d] = dilate(occupied, d, threads).size();
    occupied = coarsen(occupied, threads);
  }
  return counts;
}
} // namespace fresco::poisson
