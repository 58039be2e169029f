// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <fresco/core/array.h>
#include <fresco/core/exchange.h>
#include <utility>
#include <vector>
namespace fresco::poisson {
/// How the cube is divided among ranks. Each has the atoms, cubes of one size, of a range of the Z-order curve, and so a
/// range of the bricks, samples, vertices and faces of each depth. Depths down to the shared one are on all ranks. At
/// deeper ones a block of 4^3 bricks lies within an atom.
class Partition {
public:
  /// Shared depths of a surface take 40 MB and 0.6 s; atoms are 1/32 of the cube's side.
  static constexpr int usual_shared_depth = 8;

  /// @param first_atoms by rank, rising; the first is 0
  Partition(Exchange& exchange, int shared_depth, std::vector<std::uint64_t> first_atoms);

  /// Ranges of about the same load. @param load of each atom, summed over the ranks
  static std::vector<std::uint64_t> evenly(const std::vector<std::int64_t>& load, int ranks);

  Exchange& exchange() const { return *exchange_; }
  int rank() const { return exchange_->rank(); }
  int ranks() const { return exchange_->size(); }
  int sharedDepth() const { return shared_depth_; }
  /// Atoms are cells of this depth; and how many there are.
  int atomDepth() const { return atomDepth(shared_depth_); }
  static int atomDepth(int shared_depth) { return shared_depth - 3; }
  static std::uint64_t atomCount(int shared_depth) { return std::uint64_t(1) << 3 * atomDepth(shared_depth); }

  /// Rank that has a cell of `depth` by its Morton code. Cells larger than atoms have no owner, unless one rank has all.
  /// Bricks are cells two depths coarser.
  int ownerOf(int depth, std::uint64_t code) const;
  bool owns(int depth, std::uint64_t code) const { return ownerOf(depth, code) == rank(); }
  /// The cells of `depth` that a rank has: codes first .. last - 1.
  std::pair<std::uint64_t, std::uint64_t> codesOf(int rank, int depth) const;
  /// Where the codes of a rank's cells begin and end in a sorted array.
  std::pair<Index, Index> rangeOf(int rank, int depth, const Array<std::uint64_t>& codes) const;
  std::pair<Index, Index> ownRange(int depth, const Array<std::uint64_t>& codes) const
  {
    return rangeOf(rank(), depth, codes);
  }

  /// The other ranks with atoms that touch a cell of an own atom, rising.
  void ranksAround(int depth, std::uint64_t code, std::vector<int>& ranks) const;

private:
  Exchange* exchange_;
  int shared_depth_;
  std::vector<std::uint64_t> first_atoms_; ///< by rank, and their count
};
} // namespace fresco::poisson
