// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <vector>
namespace fresco::fuzz {
using Parts = std::vector<std::string>;

/// The same numbers everywhere for the same seed.
class Dice {
public:
  explicit Dice(std::uint32_t seed) : engine_(seed) {}
  int below(std::size_t n) { return static_cast<int>(engine_() % n); }
  int between(int least, int most) { return least + below(static_cast<std::size_t>(most - least + 1)); }
  bool chance() { return below(2) == 1; }
  template <typename T>
  const T& of(const std::vector<T>& items)
  {
    return items[static_cast<std::size_t>(below(items.size()))];
  }
  float value() { return 0.25f * static_cast<float>(between(-40, 40)); }

private:
  std::mt19937 engine_; // its sequence is the standard's, that of distributions is not
};

template <typename T>
std::string raw(T value, bool swapped = false)
{
  std::string bytes(reinterpret_cast<const char*>(&value), sizeof(value));
  if (swapped)
    std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

} // namespace fresco::fuzz
