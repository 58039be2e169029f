// SPDX-License-Identifier: BSD-3-Clause
#include "normals/plane_kernels.h"
#include "bilateral/exponential.h"
#include <cmath>
#include <limits>
namespace fresco::filters {
namespace {
double squareRoot(double a) { return std::sqrt(a); }
double least(double a, double b) { return a < b ? a : b; }
double most(double a, double b) { return a > b ? a : b; }
double ifLess(double a, double b, double yes, double no) { return a < b ? yes : no; }
} // namespace
} // namespace fresco::filters
#include "normals/plane_fit_simd.h"
namespace fresco::filters {
namespace {
void fit(const EightMoments& moments, EightPlanes& planes)
{
  planes.planes = 0;
  for (unsigned i = 0; i < 8; ++i) {
    double sums[9];
    for (int s = 0; s < 9; ++s)
      sums[s] = static_cast<double>(moments.sums[s][i]);
    const auto lanes = fitPlanes<double>(static_cast<double>(moments.weight[i]), sums);
    for (int axis = 0; axis < 3; ++axis) {
      planes.normal[axis][i] = static_cast<float>(lanes.normal[axis]);
      planes.center[axis][i] = static_cast<float>(lanes.center[axis]);
    }
    planes.variance[i] = static_cast<float>(lanes.variance);
    planes.curvature[i] = static_cast<float>(lanes.curvature);
    const bool plane = lanes.trace > 0 && lanes.trace < std::numeric_limits<double>::infinity() &&
                       lanes.second > rounding_share && lanes.squared > 0;
    planes.planes |= static_cast<unsigned>(plane) << i;
  }
}

BestPlane best(const float* planes, const std::uint16_t* list, std::size_t count, const float* own, const float* point)
{
  BestPlane result = {std::numeric_limits<float>::infinity(), 1.f, 0};
  for (std::size_t j = 0; j < count; ++j) {
    const float* p = planes + 8 * static_cast<std::size_t>(list[j]);
    const float cosine = std::abs(p[0] * own[0] + p[1] * own[1] + p[2] * own[2]);
    const float distance = p[0] * (point[0] - p[4]) + p[1] * (point[1] - p[5]) + p[2] * (point[2] - p[6]);
    const float score = p[3] + 0.5f * (distance * distance);
    result.closest = cosine < result.closest ? cosine : result.closest;
    if (score < result.score) {
      result.score = score;
      result.which = static_cast<int>(j);
    }
  }
  return result;
}

void weightedSums(const WeightedPoints& points, const float* plane, float scale, float* sums)
{
  float lanes[10][8] = {};
  for (std::size_t i = 0; i < points.count; ++i) {
    const float x = points.x[i], y = points.y[i], z = points.z[i];
    const float distance = x * plane[0] + y * plane[1] + z * plane[2] - plane[3];
    float w = scale * (distance * distance);
    exponential(&w, 1);
    const float wx = w * x, wy = w * y, wz = w * z;
    const float terms[10] = {w, wx, wy, wz, wx * x, wx * y, wx * z, wy * y, wy * z, wz * z};
    for (int t = 0; t < 10; ++t)
      lanes[t][i % 8] += terms[t];
  }
  for (int t = 0; t < 10; ++t) // as vectors of 8 lanes are added up
    sums[t] = ((lanes[t][0] + lanes[t][4]) + (lanes[t][2] + lanes[t][6])) +
              ((lanes[t][1] + lanes[t][5]) + (lanes[t][3] + lanes[t][7]));
}
} // namespace

const PlaneKernels& portablePlaneKernels()
{
  static const PlaneKernels kernels = {fit, best, weightedSums};
  return kernels;
}

const PlaneKernels& planeKernels()
{
  static const PlaneKernels& kernels = avx2PlaneKernels() ? *avx2PlaneKernels() : portablePlaneKernels();
  return kernels;
}
} // namespace fresco::filters
