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
    bytes.push_back(static_cast<std::uint8_t>(value | 0x80));
  bytes.push_back(static_cast<std::uint8_t>(value));
}
} // namespace

void CompactLists::add(const std::vector<int>& positions)
{
  const auto leafOf = [&](std::size_t j) { return static_cast<std::uint32_t>(positions[j]) / 8; };
  std::uint32_t leaves = 0, previous = 0;
  for (std::size_t j = 0; j < positions.size(); ++j)
    leaves += j == 0 || leafOf(j) != leafOf(j - 1);
  addNumber(leaves, bytes);
  for (std::size_t j = 0; j < positions.size();) {
    const std::uint32_t leaf = leafOf(j);
    unsigned mask = 0;
    for (; j < positions.size() && leafOf(j) == leaf; ++j)
      mask |= 1u << (static_cast<unsigned>(positions[j]) % 8);
    addNumber(leaf - previous, bytes);
    bytes.push_back(static_cast<std::uint8_t>(mask));
    previous = leaf;
  }
}

std::uint32_t CompactReader::number()
{
  std::uint32_t value = 0;
  int shift = 0;
  for (; *at_ & 0x80; shift += 7)
    value |= static_cast<std::uint32_t>(*at_++ & 0x7f) << shift;
  return value | static_cast<std::uint32_t>(*at_++) << shift;
}

void CompactReader::next(std::vector<int>& positions)
{
  int leaf = 0;
  std::size_t found = 0;
  const std::uint32_t leaves = number();
  positions.resize(8 * static_cast<std::size_t>(leaves) + 1); // one more is written than found
  for (std::uint32_t l = 0; l < leaves; ++l) {
    leaf += static_cast<int>(number());
    const unsigned mask = *at_++;
    for (int lane = 0; lane < 8; ++lane) { // without branches, which could not be foretold
      positions[found] = 8 * leaf + lane;
      found += mask >> lane & 1u;
    }
  }
  positions.resize(found);
}
} // namespace fresco
