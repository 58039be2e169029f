// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
namespace fresco::search {
/// Points near a query, as separate arrays.
struct KnnPoints {
  float* squared;   ///< squared distances
  float *x, *y, *z; ///< offsets from the query
  int* position;    ///< 8 * leaf + place in the leaf
};

/// Inner loops of the neighbour search over raw arrays. There is one set of them for any processor and one for those
/// with AVX2; both round alike, so that results have the same bits.
struct KnnKernels {
  /// The points of leaves of 8 (8 x, 8 y, 8 z, one after the other) whose squared distance to `query` is below
  /// `bound`, leaf by leaf in the order of `leaves`.
  /// @param squared,position out: squared distances, and 8 * leaf + place in the leaf; room for 8 * leaf_count + 8
  /// @return how many
  std::size_t (*closer)(const float* coordinates, const int* leaves, std::size_t leaf_count, const float* query,
                        float bound, float* squared, int* position);

  /// As closer(), with offsets.
  std::size_t (*offsets)(const float* coordinates, const int* leaves, std::size_t leaf_count, const float* query,
                         float bound, const KnnPoints& points);

  /// Boxes around the points of leaves: of leaf l the low and high ends on each axis are boxes[axis * stride + l] and
  /// boxes[(3 + axis) * stride + l].
  void (*boxes)(const float* coordinates, std::size_t leaf_count, std::size_t stride, float* boxes);

  /// The leaves (numbers) whose boxes are closer than `reach` to that of leaf `center`, itself included, ascending.
  /// @param boxes of a stride that is a multiple of 8 and no smaller than leaf_count; @param leaves room for stride + 8
  std::size_t (*closeBoxes)(const float* boxes, std::size_t leaf_count, std::size_t stride, std::size_t center,
                            float reach, int* leaves);

  /// A threshold that exactly `k` of values[0 .. count - 1] are below, see kthSmallest(). All are below `bound`.
  /// @param values with room for count + 8; those from count on become infinite
  float (*limit)(float* values, std::size_t count, std::size_t k, float bound);

  /// Sums over the points whose squared distance is below `limit`: x, y, z, xx, xy, xz, yy, yz, zz, and the largest
  /// squared distance. Their positions go to `chosen`, in order.
  /// @param points with room for count + 8; squared distances from count on become infinite
  void (*sum)(const KnnPoints& points, std::size_t count, float limit, float* sums, int* chosen);

  /// How many of values[0 .. count - 1] are smaller than each of them.
  /// @param values,ranks with room for count + 8; values from count on become infinite
  void (*rank)(float* values, std::size_t count, int* ranks);
};

const KnnKernels& knnKernels();         ///< the fastest ones that this processor runs
const KnnKernels& portableKnnKernels(); ///< those that run everywhere
const KnnKernels* avx2KnnKernels();     ///< null where the processor has no AVX2
} // namespace fresco::search
