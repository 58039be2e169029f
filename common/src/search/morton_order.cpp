// SPDX-License-Identifier: BSD-3-Clause
#include "search/morton_order.h"

#include <algorithm>
#include <array>
#include <fresco/core/morton.h>
#include <fresco/core/parallel.h>
#include <utility>
namespace fresco::search {
namespace {
struct Key {
  std::uint32_t code;
  std::int32_t column;
};

// 30 bits; z is the lowest.
std::uint32_t codeOf(const Eigen::Array3d& cell)
{
  const Eigen::Array<std::uint32_t, 3, 1> whole = cell.max(0.0).min(1023.0).cast<std::uint32_t>();
  const std::uint64_t code = mortonCode(whole[2], whole[1], whole[0]);
  return code;
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
  const Index n = points.cols();
  if (n == 0)
    return {};
  const Eigen::Array3d low = points.rowwise().minCoeff();
  const double side = (points.rowwise().maxCoeff().array() - low).maxCoeff();
  const double scale = side > 0.0 ? 1024.0 / side : 0.0;
  std::vector<Key> keys(n), other(n);
  parallelFor(points.cols(), threads, [&](Index i) {
    keys[i] = {codeOf((points.col(i).array() - low) * scale), static_cast<std::int32_t>(i)};
  });
  for (const int shift : {0, 10, 20}) {
    sortByDigit(keys, other, shift);
    keys.swap(other);
  }
  std::vector<std::int32_t> order(n);
  std::transform(keys.begin(), keys.end(), order.begin(), [](const Key& key) { return key.column; });
  return order;
}
} // namespace fresco::search
