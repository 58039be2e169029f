// SPDX-License-Identifier: BSD-3-Clause
#include "search/knn_kernels.h"
#include "search/kth_smallest.h"
#include <algorithm>
#include <limits>
namespace fresco::search {
namespace {
constexpr float infinity = std::numeric_limits<float>::infinity();

/// From the query to the eight points of a leaf.
inline void squaredDistances(const float* leaf, const float* query, float* distances)
{
  for (int i = 0; i < 8; ++i) {
    const float dx = leaf[i] - query[0], dy = leaf[8 + i] - query[1], dz = leaf[16 + i] - query[2];
    distances[i] = dx * dx + dy * dy + dz * dz;
  }
}

std::size_t closer(const float* coordinates, const int* leaves, std::size_t leaf_count, const float* query, float bound,
                   float* squared, int* position)
{
  std::size_t found = 0;
  for (std::size_t l = 0; l < leaf_count; ++l) {
    const float* leaf = coordinates + 24 * std::ptrdiff_t{leaves[l]};
    float distances[8];
    squaredDistances(leaf, query, distances);
    for (int i = 0; i < 8; ++i) {
      squared[found] = distances[i];
      position[found] = leaves[l] * 8 + i;
      found += distances[i] < bound;
    }
  }
  return found;
}

std::size_t offsets(const float* coordinates, const int* leaves, std::size_t leaf_count, const float* query,
                    float bound, const KnnPoints& points)
{
  std::size_t found = 0;
  for (std::size_t l = 0; l < leaf_count; ++l) {
    const float* leaf = coordinates + 24 * std::ptrdiff_t{leaves[l]};
    float distances[8];
    squaredDistances(leaf, query, distances);
    for (int i = 0; i < 8; ++i) {
      points.squared[found] = distances[i];
      points.x[found] = leaf[i] - query[0];
      points.y[found] = leaf[8 + i] - query[1];
      points.z[found] = leaf[16 + i] - query[2];
      points.position[found] = leaves[l] * 8 + i;
      found += distances[i] < bound;
    }
  }
  return found;
}

void boxes(const float* coordinates, std::size_t leaf_count, std::size_t stride, float* boxes)
{
  for (std::size_t l = 0; l < leaf_count; ++l)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float* values = coordinates + 24 * l + 8 * axis;
      boxes[axis * stride + l] = *std::min_element(values, values + 8);
      boxes[(3 + axis) * stride + l] = *std::max_element(values, values + 8);
    }
}

std::size_t closeBoxes(const float* boxes, std::size_t leaf_count, std::size_t stride, std::size_t center, float reach,
                       int* leaves)
{
  std::size_t found = 0;
  for (std::size_t l = 0; l < leaf_count; ++l) {
    float gaps[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float *low = boxes + axis * stride, *high = low + 3 * stride;
      gaps[axis] = std::max(std::max(low[l] - high[center], low[center] - high[l]), 0.f);
    }
    leaves[found] = l;
    found += gaps[0] * gaps[0] + gaps[1] * gaps[1] + gaps[2] * gaps[2] <= reach * reach;
  }
  return found;
}

struct Counter {
  const float* values;
  std::size_t count;
  std::size_t below(float limit) const
  {
    std::size_t found = 0;
    for (std::size_t i = 0; i < count; ++i)
      found += values[i] < limit;
    return found;
  }
};

float limit(float* values, std::size_t count, std::size_t k, float bound)
{
  for (std::size_t i = count; i < (count + 7) / 8 * 8; ++i)
    values[i] = infinity;
  return kthSmallest(Counter{values, count}, count, k, bound);
}

/// In the order in which vectors of 8 lanes are added up.
float total(const float* lanes)
{
  return ((lanes[0] + lanes[4]) + (lanes[2] + lanes[6])) + ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7]));
}

void sum(const KnnPoints& points, std::size_t count, float limit, float* sums, int* chosen)
{
  float lanes[9][8] = {}, largest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const bool in = points.squared[i] < limit;
    *chosen = points.position[i];
    chosen += in;
    const float x = in ? points.x[i] : 0.f, y = in ? points.y[i] : 0.f, z = in ? points.z[i] : 0.f;
    const float terms[9] = {x, y, z, x * x, x * y, x * z, y * y, y * z, z * z};
    for (int t = 0; t < 9; ++t)
      lanes[t][i % 8] += terms[t];
    largest = in && points.squared[i] > largest ? points.squared[i] : largest;
  }
  for (std::size_t i = count; i < (count + 7) / 8 * 8; ++i)
    points.squared[i] = infinity;
  for (int t = 0; t < 9; ++t)
    sums[t] = total(lanes[t]);
  sums[9] = largest;
}

void rank(float* values, std::size_t count, int* ranks)
{
  const std::size_t rounded = (count + 7) / 8 * 8;
  for (std::size_t i = count; i < rounded; ++i)
    values[i] = infinity;
  for (std::size_t i = 0; i < rounded; i += 8) {
    int smaller[8] = {0, 0, 0, 0, 0, 0, 0, 0};
    for (std::size_t j = 0; j < count; ++j)
      for (std::size_t lane = 0; lane < 8; ++lane)
        smaller[lane] += values[j] < values[i + lane];
    for (std::size_t lane = 0; lane < 8; ++lane)
      ranks[i + lane] = smaller[lane];
  }
}
} // namespace

const KnnKernels& portableKnnKernels()
{
  static const KnnKernels kernels = {closer, offsets, boxes, closeBoxes, limit, sum, rank};
  return kernels;
}

const KnnKernels& knnKernels()
{
  static const KnnKernels& kernels = avx2KnnKernels() ? *avx2KnnKernels() : portableKnnKernels();
  return kernels;
}
} // namespace fresco::search
