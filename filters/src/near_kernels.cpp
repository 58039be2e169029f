// SPDX-License-Identifier: BSD-3-Clause
#include "near_kernels.h"
#include <limits>
namespace fresco {
namespace {
std::size_t closer(const float* coordinates, const int* leaves, std::size_t leaf_count, const float* query, float bound,
                   float* squared, int* position)
{
  std::size_t found = 0;
  for (std::size_t l = 0; l < leaf_count; ++l) {
    const float* leaf = coordinates + static_cast<std::size_t>(leaves[l]) * 24;
    float distances[8];
    for (int i = 0; i < 8; ++i) {
      const float dx = leaf[i] - query[0], dy = leaf[8 + i] - query[1], dz = leaf[16 + i] - query[2];
      distances[i] = dx * dx + dy * dy + dz * dz;
    }
    for (int i = 0; i < 8; ++i) {
      squared[found] = distances[i];
      position[found] = leaves[l] * 8 + i;
      found += distances[i] < bound;
    }
  }
  return found;
}

void rank(float* values, std::size_t count, int* ranks)
{
  const std::size_t rounded = (count + 7) / 8 * 8;
  for (std::size_t i = count; i < rounded; ++i)
    values[i] = std::numeric_limits<float>::infinity();
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

const NearKernels& portableNearKernels()
{
  static const NearKernels kernels = {closer, rank};
  return kernels;
}

const NearKernels& nearKernels()
{
  static const NearKernels& kernels = avx2NearKernels() ? *avx2NearKernels() : portableNearKernels();
  return kernels;
}
} // namespace fresco
