// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/text_table.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/point_table.h>
#include <fresco/core/require.h>
namespace fresco::io {
namespace {
constexpr std::size_t none = 0; ///< no columns of that kind: x y z are the first

/// Where the columns of normals and colours begin.
struct Reading {
  std::size_t normal = none, color = none;

  /// Normals count more: what has length 1 in every row is hardly a colour.
  int score() const { return (normal != none ? 3 : 0) + (color != none ? 2 : 0); }
  bool overlaps() const
  {
    return normal != none && color != none && std::max(normal, color) - std::min(normal, color) < 3;
  }
};

class Guess {
public:
  Guess(const std::vector<double>& values, std::size_t width) : values_(values), width_(width)
  {
    normals_.push_back(none);
    colors_.push_back(none);
    for (std::size_t c = 3; c + 3 <= width; ++c) {
      if (isNormal(c))
        normals_.push_back(c);
      if (isColor(c))
        colors_.push_back(c);
    }
  }

  std::vector<std::string> names() const
  {
    const std::vector<Reading> best = bestReadings();
    if (best.size() == 1 || best[0].normal != best[1].normal)
      return namesOf(best[0]);
    for (const Reading& reading : best) {
      const bool closest = std::all_of(best.begin(), best.end(), [&](const Reading& other) {
        return other.color == reading.color || spread(reading.color) < 0.5 * spread(other.color);
      });
      if (closest || (isAlpha(reading.color + 3) && !isAlpha(reading.color)))
        return namesOf(reading);
    }
    const std::size_t further = width_ - 6 - (best[0].normal != none ? 3 : 0);
    if (further == 1 && isWhole(best.back().color, 255)) // x y z intensity r g b, as in PTS
      return namesOf(best.back());
    throw std::runtime_error(concat("the columns may be '", listOf(namesOf(best[0])), "' or '",
                                    listOf(namesOf(best.back())), "': ", columns_hint));
  }

private:
  std::vector<Reading> bestReadings() const
  {
    std::vector<Reading> best{{}};
    for (const std::size_t normal : normals_)
      for (const std::size_t color : colors_) {
        const Reading reading{normal, color};
        if (reading.overlaps() || reading.score() < best[0].score())
          continue;
        if (reading.score() > best[0].score())
          best.clear();
        best.push_back(reading);
      }
    return best;
  }

  std::vector<std::string> namesOf(const Reading& reading) const
  {
    std::vector<std::string> names(width_);
    const auto set = [&](std::size_t begin, NameTriple triple) {
      std::copy(triple, triple + 3, names.begin() + begin);
    };
    if (reading.normal != none)
      set(reading.normal, normal_names);
    if (reading.color != none)
      set(reading.color, color_names);
    set(0, xyz_names);
    const bool single = std::count(names.begin(), names.end(), "") == 1;
    for (std::size_t c = 0; c < width_; ++c)
      if (names[c].empty())
        names[c] = !single                                                         ? concat("column_", c + 1)
                   : reading.color != none && c == reading.color + 3 && isAlpha(c) ? "alpha"
                                                                                   : "intensity";
    return names;
  }

  /// Whether all values of columns c .. c + count - 1 fulfil `test`; NaN does.
  template <typename Test>
  bool all(std::size_t c, std::size_t count, const Test& test) const
  {
    for (std::size_t at = c; at < values_.size(); at += width_)
      for (std::size_t k = 0; k < count; ++k)
        if (!std::isnan(values_[at + k]) && !test(values_[at + k]))
          return false;
    return true;
  }

  bool isWhole(std::size_t c, double most) const
  {
    return all(c, 3, [&](double v) { return v >= 0 && v <= most && v == std::floor(v); });
  }

  bool isColor(std::size_t c) const
  {
    constexpr double most = 65535;
    return isWhole(c, width_ == 6 ? most : 255) || all(c, 3, [](double v) { return v >= 0 && v <= 1; });
  }

  bool isAlpha(std::size_t c) const
  {
    return c < width_ && all(c, 1, [](double v) { return v == 255; });
  }

  bool isNormal(std::size_t c) const
  {
    constexpr double rounded = 0.02; // two decimals
    bool any = false;
    for (std::size_t at = c; at < values_.size(); at += width_) {
      const double length = std::hypot(values_[at], values_[at + 1], values_[at + 2]);
      if (std::abs(length - 1) > rounded && length != 0)
        return false;
      any = any || length != 0;
    }
    return any;
  }

  /// Red, green and blue of a point are closer to each other than to its intensity.
  double spread(std::size_t c) const
  {
    double sum = 0;
    for (std::size_t at = c; at < values_.size(); at += width_)
      if (const double d = std::abs(values_[at] - values_[at + 1]) + std::abs(values_[at + 1] - values_[at + 2]); d > 0)
        sum += d;
    return sum;
  }

  const std::vector<double>& values_;
  const std::size_t width_;
  std::vector<std::size_t> normals_, colors_; ///< where they may begin
};
} // namespace

std::vector<std::string> guessColumns(const std::vector<double>& values, std::size_t width)
{
  return Guess(values, width).names();
}
} // namespace fresco::io
