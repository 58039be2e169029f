// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
namespace fresco {
/// Inner loops of the neighbour search over raw arrays. There is one set of them for any processor and one for those
/// with AVX2; both round alike, so that results have the same bits.
struct NearKernels {
  /// The points of leaves of 8 (8 x, 8 y, 8 z, one after the other) whose squared distance to `query` is below
  /// `bound`, leaf by leaf in the order of `leaves`.
  /// @param squared,position out: squared distances, and 8 * leaf + place in the leaf; room for 8 * leaf_count + 8
  /// @return how many
  std::size_t (*closer)(const float* coordinates, const int* leaves, std::size_t leaf_count, const float* query,
                        float bound, float* squared, int* position);

  /// How many of values[0 .. count - 1] are smaller than each of them.
  /// @param values,ranks with room for count + 8; values from count on become infinite
  void (*rank)(float* values, std::size_t count, int* ranks);
};

const NearKernels& nearKernels();         ///< the fastest ones that this processor runs
const NearKernels& portableNearKernels(); ///< those that run everywhere
const NearKernels* avx2NearKernels();     ///< null where the processor has no AVX2
} // namespace fresco
