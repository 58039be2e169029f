// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <fresco/core/array.h>
namespace fresco::poisson {
/// Consecutive samples, to loop over their numbers.
class SampleRun {
public:
  struct Iterator {
    std::uint32_t sample;
    std::uint32_t operator*() const { return sample; }
    void operator++() { ++sample; }
    bool operator!=(const Iterator& other) const { return sample != other.sample; }
  };

  SampleRun(std::uint32_t begin, std::uint32_t end) : begin_(begin), end_(end) {}
  Iterator begin() const { return {begin_}; }
  Iterator end() const { return {end_}; }
  bool empty() const { return begin_ == end_; }

private:
  std::uint32_t begin_, end_;
};

/// The samples of each brick of a depth.
struct SampleRanges {
  Array<std::uint32_t> begin; ///< first sample of each brick, and the number of all
  Array<std::uint32_t> end;   ///< empty where each sample has a brick: then where the next one begins

  template <typename Number>
  SampleRun operator[](Number b) const
  {
    return {begin[b], end.empty() ? begin[b + 1] : end[b]};
  }
};
} // namespace fresco::poisson
