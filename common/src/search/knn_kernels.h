// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
namespace fresco::search {
/// Points near a query, as separate arrays.
struct KnnPoints {
  float* squared;        ///< squared distances
  float *x, *y, *z;      ///< offsets from the query
  int* position;         ///< 8 * leaf + place in the leaf
  std::size_t count = 0; ///< of points
};

/// Leaves of 8 points: 8 x, 8 y, 8 z, one after the other.
struct KnnLeaves {
  const float* coordinates;
  const int* list;   ///< numbers of leaves
  std::size_t count; ///< of the list
};

/// Boxes around the points of leaves: of leaf l the low and high ends on each axis are ends[axis * stride + l] and
/// ends[(3 + axis) * stride + l].
struct KnnBoxes {
  float* ends;
  std::size_t count;
  std::size_t stride; ///< a multiple of 8, no smaller than `count`
};

/// Inner loops of the neighbour search over raw arrays. There is one set of them for any processor and one for those
/// with AVX2; both round alike, so that results have the same bits.
struct KnnKernels {
  /// The points of leaves whose squared distance to `query` is below `bound`, leaf by leaf in the order of the list.
  /// @param points out: squared distances and positions; room for 8 * leaves.count + 8
  /// @return how many
  std::size_t (*closer)(const KnnLeaves& leaves, const float* query, float bound, const KnnPoints& points);

  /// As closer(), with offsets.
  std::size_t (*offsets)(const KnnLeaves& leaves, const float* query, float bound, const KnnPoints& points);

  /// Of the leaves 0 .. boxes.count - 1.
  void (*boxes)(const float* coordinates, const KnnBoxes& boxes);

  /// The leaves (numbers) whose boxes are closer than `reach` to that of leaf `center`, itself included, ascending.
  /// @param leaves room for boxes.stride + 8
  std::size_t (*closeBoxes)(const KnnBoxes& boxes, std::size_t center, float reach, int* leaves);

  /// A threshold that separates the `k` smallest of values[0 .. count - 1] from the others: exactly `k` are below it.
  /// Negative where there is none, as two values are equal, or where 40 steps do not find it.
  /// @param values in 0 .. `bound`, with room for count + 8; those from count on become infinite
  float (*limit)(float* values, std::size_t count, std::size_t k, float bound);

  /// Sums over the points whose squared distance is below `limit`: x, y, z, xx, xy, xz, yy, yz, zz, and the largest
  /// squared distance. Their positions go to `chosen`, in order.
  /// @param points with room for count + 8; squared distances from count on become infinite
  void (*sum)(const KnnPoints& points, float limit, float* sums, int* chosen);

  /// How many of values[0 .. count - 1] are smaller than each of them.
  /// @param values,ranks with room for count + 8; values from count on become infinite
  void (*rank)(float* values, std::size_t count, int* ranks);
};

const KnnKernels& knnKernels();         ///< the fastest ones that this processor runs
const KnnKernels& portableKnnKernels(); ///< those that run everywhere
const KnnKernels* avx2KnnKernels();     ///< null where the processor has no AVX2
} // namespace fresco::search
