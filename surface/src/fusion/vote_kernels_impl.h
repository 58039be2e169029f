// SPDX-License-Identifier: BSD-3-Clause
// The kernels, for the instructions that the including file is compiled for. No header with inline functions of external
// linkage may be used here: the linker could keep their AVX2 code for the whole program.
#pragma once
#include "fusion/vote_kernels.h"
#include <fresco/core/simd.h>
namespace fresco::fusion {
namespace {
using namespace simd;

/// @param u, v  lanes within the image
/// @param depth out: as a result, compilers would warn of its registers
inline void readDepth(const DepthPixels& image, const Float8& u, const Float8& v, Float8& depth)
{
  const Int8 iu = __builtin_convertvector(u, Int8), iv = __builtin_convertvector(v, Int8);
  const Float8 fu = u - __builtin_convertvector(iu, Float8), fv = v - __builtin_convertvector(iv, Float8);
  const Int8 at = iv * image.width + iu;
  const Float8 a = gathered(image.depth, at), b = gathered(image.depth, at + 1);
  const Float8 c = gathered(image.depth, at + image.width), d = gathered(image.depth, at + image.width + 1);
  const Float8 least = smaller(smaller(a, b), smaller(c, d)), greatest = larger(larger(a, b), larger(c, d));
  const Int8 right = fu > 0.5f;
  const Float8 nearest = (fv > 0.5f) ? (right ? d : c) : (right ? b : a);
  const Float8 mean = (a * (1.f - fu) + b * fu) * (1.f - fv) + (c * (1.f - fu) + d * fu) * fv;
  depth = ((least <= 0.f) | (greatest - least > depth_jump * nearest)) ? nearest : mean;
}

inline Float8 robustWeight(const Float8& residual, float scale)
{
  const Float8 t = 1.f + residual * residual / (scale * scale);
  return 1.f / (t * t);
}

inline float vote(const DepthPixels& image, const BrickView& view, const VoteSettings& settings,
                  const BrickVotes& nodes)
{
  const Float8 lanes = __builtin_convertvector(lane_numbers, Float8);
  Float8 votes{};
  for (int row = 0; row < brick_side * brick_side; ++row) {
    Float8 p[3];
    for (int k = 0; k < 3; ++k)
      p[k] = view.first[k] + row % brick_side * view.step[1][k] + row / brick_side * view.step[2][k] +
             lanes * view.step[0][k];
    // The weight of a vote lies between that for the error of the poses, the same near and far, and 1 / variance of
    // the noise, which falls with z^4.
    const Float8 inverse = 1.f / p[2];
    const Float8 u = p[0] * inverse * image.fx + image.cx, v = p[1] * inverse * image.fy + image.cy;
    const Int8 seen =
        (p[2] > settings.nearest) & (u >= 0.f) & (v >= 0.f) & (u < image.width - 1.f) & (v < image.height - 1.f);
    if (lanesOf(seen) == 0)
      continue;
    Float8 depth;
    readDepth(image, seen ? u : Float8{}, seen ? v : Float8{}, depth);
    Float8 distance = depth - p[2];
    const Int8 told = seen & (depth > 0.f) & (distance >= -settings.truncation);
    if (lanesOf(told) == 0)
      continue;
    const Int8 free = distance > settings.truncation;
    distance = free ? Float8{} + settings.truncation : distance;
    Float8 weight = free ? inverse * settings.free_weight : inverse;
    votes += (told & ~free) ? weight : Float8{};
    if (nodes.reference)
      weight *= robustWeight(distance - load<Float8>(nodes.reference + row * brick_side), settings.scale);
    float *means = nodes.distance + row * brick_side, *weights = nodes.weight + row * brick_side;
    const Float8 old = load<Float8>(weights), mean = load<Float8>(means), sum = old + weight;
    store(told ? sum : old, weights);
    store(told ? mean + weight / sum * (distance - mean) : mean, means);
  }
  return total(votes);
}

inline constexpr VoteKernels kernels{vote};
} // namespace
} // namespace fresco::fusion
