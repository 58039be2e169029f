// SPDX-License-Identifier: BSD-3-Clause
#include "compact_lists.h"
#include <cstddef>
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
  std::uint32_t leaves = 0;
  for (std::size_t j = 0; j < positions.size(); ++j)
    leaves += j == 0 || positions[j] / 8 != positions[j - 1] / 8;
  addNumber(leaves, bytes);
  int previous = 0;
  for (std::size_t j = 0; j < positions.size();) {
    const int leaf = positions[j] / 8;
    unsigned mask = 0;
    for (; j < positions.size() && positions[j] / 8 == leaf; ++j)
      mask |= 1u << (positions[j] % 8);
    addNumber(static_cast<std::uint32_t>(leaf - previous), bytes);
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
  positions.clear();
  int leaf = 0;
  for (std::uint32_t leaves = number(); leaves > 0; --leaves) {
    leaf += static_cast<int>(number());
    const unsigned mask = *at_++;
    for (int lane = 0; lane < 8; ++lane)
      if (mask >> lane & 1u)
        positions.push_back(8 * leaf + lane);
  }
}
} // namespace fresco
