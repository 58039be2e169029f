// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <fresco/core/export.h>
#include <fresco/core/require.h>
#include <fresco/core/types.h>
#include <limits>
#include <vector>
namespace fresco::core {
/// add(i, k, l) for the triangles of a polygon of corners begin..end: halves of halves.
template <typename Add>
void addHalves(std::size_t begin, std::size_t end, const Add& add)
{
  if (end - begin < 2)
    return;
  const std::size_t middle = begin + (end - begin) / 2;
  add(begin, middle, end);
  addHalves(begin, middle, add);
  addHalves(middle, end, add);
}

/// add(i, k, l) for the triangles of a polygon of `count` corners: a fan, or halves of halves where a corner of a fan
/// would have so many triangles around it that whatever looks at neighbours takes quadratic time.
template <typename Add>
void triangulate(std::size_t count, const Add& add)
{
  constexpr std::size_t largest_fan = 32;
  if (count > largest_fan)
    addHalves(0, count - 1, add);
  else
    for (std::size_t i = 2; i < count; ++i)
      add(std::size_t{0}, i - 1, i);
}

/// Triangles from the polygons and strips of a file.
class FRESCO_EXPORT FaceCollector {
public:
  /// See triangulate(); fewer than three corners give nothing.
  void addPolygon(const std::int64_t* corners, std::size_t count)
  {
    triangulate(count, [&](std::size_t i, std::size_t k, std::size_t l) { add(corners[i], corners[k], corners[l]); });
  }

  void addTriangle(const std::array<int, 3>& corners)
  {
    indices_.insert(indices_.end(), corners.begin(), corners.end());
  }

  /// -1 begins a new strip. Triangles with a repeated corner only join strips and are left out.
  void addStrip(const std::int64_t* corners, std::size_t count)
  {
    std::size_t begin = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (corners[i] == -1) {
        begin = i + 1;
        continue;
      }
      if (i < begin + 2)
        continue;
      const std::int64_t a = corners[i - 2], b = corners[i - 1], c = corners[i];
      if (a == b || b == c || a == c)
        continue;
      const bool even = (i - begin) % 2 == 0;
      add(even ? a : b, even ? b : a, c);
    }
  }

  /// @throws std::runtime_error if an index is not one of `vertices`
  Faces faces(Index vertices) const
  {
    for (const int index : indices_)
      if (index < 0 || index >= vertices)
        throw std::runtime_error(concat("a face names vertex ", index, ", there are ", vertices));
    return Eigen::Map<const Faces>(indices_.data(), 3, static_cast<Index>(indices_.size() / 3));
  }

private:
  void add(std::int64_t a, std::int64_t b, std::int64_t c)
  {
    for (const std::int64_t index : {a, b, c})
      indices_.push_back(static_cast<int>(std::clamp<std::int64_t>(index, -1, std::numeric_limits<int>::max())));
  }
  std::vector<int> indices_;
};
} // namespace fresco::core
