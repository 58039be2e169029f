// SPDX-License-Identifier: BSD-3-Clause
#include <fresco/search/morton_order.h>

#include <algorithm>
#include <array>
#include <fresco/core/parallel.h>
#include <utility>
namespace fresco {
namespace {
struct Key {
  std::uint32_t code;
  std::int32_t column;
};

// Spreads the lower 10 bits so that two zeros follow each.
std::uint32_t spreadBits(std::uint32_t x)
{
  x = (x | (x << 16)) & 0x030000ffu;
  x = (x | (x << 8)) & 0x0300f00fu;
  x = (x | (x << 4)) & 0x030c30c3u;
  return (x | (x << 2)) & 0x09249249u;
}

std::uint32_t mortonCode(const Eigen::Array3d& cell)
{
  const auto axis = [&](int a) { return spreadBits(static_cast<std::uint32_t>(std::clamp(cell[a], 0.0, 1023.0))); };
  return (axis(0) << 2) | (axis(1) << 1) | axis(2);
}

// One pass of a least-significant-digit radix sort.
void sortByDigit(const std::vector<Key>& from, std::vector<Key>& to, int shift)
{
  std::array<std::size_t, 1024> start{};
  const auto digit = [shift](const Key& key) { return (key.code >> shift) & 1023u; };
  for (const Key& key : from)
    ++start[digit(key)];
  std::size_t sum = 0;
  for (std::size_t& entry : start)
    sum += std::exchange(entry, sum);
  for (const Key& key : from)
    to[start[digit(key)]++] = key;
}
} // namespace

std::vector<std::int32_t> mortonOrder(const Eigen::Matrix3Xd& points, int threads)
{
  const auto n = static_cast<std::size_t>(points.cols());
  if (n == 0)
    return {};
  const Eigen::Array3d low = points.rowwise().minCoeff();
  const double side = (points.rowwise().maxCoeff().array() - low).maxCoeff();
  const double scale = side > 0.0 ? 1024.0 / side : 0.0;
  std::vector<Key> keys(n), other(n);
  parallelFor(points.cols(), threads, [&](Index i) {
    keys[i] = {mortonCode((points.col(i).array() - low) * scale), static_cast<std::int32_t>(i)};
  });
  for (const int shift : {0, 10, 20}) {
    sortByDigit(keys, other, shift);
    keys.swap(other);
  }
  std::vector<std::int32_t> order(n);
  std::transform(keys.begin(), keys.end(), order.begin(), [](const Key& key) { return key.column; });
  return order;
}
} // namespace fresco
