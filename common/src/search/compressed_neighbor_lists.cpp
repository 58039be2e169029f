// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <fresco/search/compressed_neighbor_lists.h>
namespace fresco {
namespace {
static_assert(PointTree::leaf_size == 8, "the points of a leaf are the bits of a byte");

/// Seven bits per byte, low ones first; the eighth says that more follow.
void addNumber(std::uint32_t value, std::vector<std::uint8_t>& bytes)
{
  for (; value >= 0x80; value >>= 7)
    bytes.push_back(value | 0x80);
  bytes.push_back(value);
}
} // namespace

void CompressedLists::add(const std::vector<int>& positions)
{
  const auto leafOf = [&](std::size_t j) { return positions[j] / 8u; };
  std::uint32_t leaves = 0, previous = 0;
  for (std::size_t j = 0; j < positions.size(); ++j)
    leaves += j == 0 || leafOf(j) != leafOf(j - 1);
  addNumber(leaves, bytes);
  for (std::size_t j = 0; j < positions.size();) {
    const std::uint32_t leaf = leafOf(j);
    unsigned mask = 0;
    for (; j < positions.size() && leafOf(j) == leaf; ++j)
      mask |= 1u << positions[j] % 8;
    addNumber(leaf - previous, bytes);
    bytes.push_back(mask);
    previous = leaf;
  }
}

std::uint32_t CompressedReader::number()
{
  std::uint32_t value = 0;
  int shift = 0;
  for (; *at_ & 0x80; shift += 7)
    value |= (*at_++ & 0x7fu) << shift;
  return value | std::uint32_t{*at_++} << shift;
}

void CompressedReader::next(std::vector<int>& positions)
{
  int leaf = 0;
  std::size_t found = 0;
  const std::uint32_t leaves = number();
  positions.resize(8 * std::size_t{leaves} + 1); // one more is written than found
  for (std::uint32_t l = 0; l < leaves; ++l) {
    leaf += number();
    const unsigned mask = *at_++;
    for (int lane = 0; lane < 8; ++lane) { // without branches, which could not be foretold
      positions[found] = 8 * leaf + lane;
      found += mask >> lane & 1u;
    }
  }
  positions.resize(found);
}
} // namespace fresco
