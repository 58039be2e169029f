// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <cstdint>
namespace fresco::filters {
/// Sums over eight sets of points.
struct EightMoments {
  float weight[8];
  float sums[9][8]; ///< x, y, z, xx, xy, xz, yy, yz, zz: offsets from a point nearby
};

struct EightPlanes {
  float normal[3][8], center[3][8], variance[8], curvature[8]; ///< see Plane
  unsigned planes; ///< bit i: set i has a plane; the others are points or lines, with nothing of use in the arrays
};

struct WeightedPoints {
  float *x, *y, *z; ///< offsets from a point nearby
  std::size_t count;
};

/// What the search for the best of neighbouring planes finds.
struct BestPlane {
  float score;   ///< of the best
  float closest; ///< smallest absolute cosine between normals
  int which;     ///< place in the list of the first with the best score
};

constexpr double rounding_share = 1e-6; // of the variances of points: sums in single precision tell no smaller ones

/// Inner loops of plane fits over raw arrays; as KnnKernels, with the same bits on any processor.
struct PlaneKernels {
  void (*fit)(const EightMoments& moments, EightPlanes& planes);

  /// The best of the planes in a list for a point: variance + half the squared distance is least.
  /// @param planes rows of 8: normal, variance, center, anything; @param own the row of the point
  BestPlane (*best)(const float* planes, const std::uint16_t* list, std::size_t count, const float* own,
                    const float* point);

  /// Weight and sums (as EightMoments) of points weighted by exp(scale * d^2), d the distance to a plane.
  /// @param x,y,z room for count + 8 @param plane normal and height
  void (*weightedSums)(const WeightedPoints& points, const float* plane, float scale, float* sums);
};

const PlaneKernels& planeKernels();
const PlaneKernels& portablePlaneKernels();
const PlaneKernels* avx2PlaneKernels();
} // namespace fresco::filters
