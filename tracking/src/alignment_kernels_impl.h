// SPDX-License-Identifier: BSD-3-Clause
// The kernels, for the instructions that the including file is compiled for. No header with inline functions of external
// linkage may be used here: the linker could keep their AVX2 code for the whole program.
#pragma once
#include "alignment_kernels.h"
#include <fresco/core/simd.h>
namespace fresco::tracking {
namespace {
using namespace simd;

inline Float8 ones(const Int8& mask) { return mask ? Float8{} + 1.f : Float8{}; }

/// w(r) = (5 + 1) / (5 + r^2 / s^2): Kerl, Sturm, Cremers 2013.
inline Float8 weightOf(const Float8& squared, float scale) { return 6.f / (5.f + squared * scale); }

/// Adds w J J^T and w r J with J = [p x d, d].
struct Equations {
  Float8 sums[27] = {};

  void add(const Float8* p, const Float8* d, const Float8& w, const Float8& r)
  {
    const Float8 J[6] = {
        p[1] * d[2] - p[2] * d[1], p[2] * d[0] - p[0] * d[2], p[0] * d[1] - p[1] * d[0], d[0], d[1], d[2]};
    int k = 0;
    for (int i = 0; i < 6; ++i) {
      const Float8 wJ = w * J[i];
      for (int j = i; j < 6; ++j)
        sums[k++] += wJ * J[j];
    }
    for (int i = 0; i < 6; ++i)
      sums[21 + i] += w * r * J[i];
  }
};

inline Float8 bilinear(const float* image, int width, const Float8& u, const Float8& v)
{
  const Int8 iu = __builtin_convertvector(u, Int8), iv = __builtin_convertvector(v, Int8);
  const Float8 fu = u - __builtin_convertvector(iu, Float8), fv = v - __builtin_convertvector(iv, Float8);
  const Int8 at = iv * width + iu;
  const Float8 a = gathered(image, at), b = gathered(image, at + 1);
  const Float8 c = gathered(image, at + width), d = gathered(image, at + width + 1);
  const Float8 upper = a + fu * (b - a), lower = c + fu * (d - c);
  return upper + fv * (lower - upper);
}

inline void accumulate(const ReferenceArrays& ref, std::size_t begin, std::size_t end, const CurrentArrays& cur,
                       const Linearization& at, AlignmentSums& out)
{
  Equations equations;
  Float8 others[9] = {};
  const float *R = at.R, *t = at.t;
  for (std::size_t i = begin; i < end; i += 8) {
    const Float8 p[3] = {load<Float8>(ref.x + i), load<Float8>(ref.y + i), load<Float8>(ref.z + i)};
    const Float8 n[3] = {load<Float8>(ref.nx + i), load<Float8>(ref.ny + i), load<Float8>(ref.nz + i)};
    Float8 q[3];
    for (int k = 0; k < 3; ++k)
      q[k] = R[3 * k] * p[0] + R[3 * k + 1] * p[1] + R[3 * k + 2] * p[2] + t[k];
    const Int8 real = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2] > 0.f) & (q[2] > 1e-3f);
    const Float8 z = real ? q[2] : Float8{} + 1.f, inverse = 1.f / z;
    // Depth: the pixel that the point falls on.
    const Float8 u = q[0] * inverse * cur.fx + (cur.cx + 0.5f), v = q[1] * inverse * cur.fy + (cur.cy + 0.5f);
    const Int8 inside = real & (u >= 0.f) & (v >= 0.f) & (u < float(cur.width)) & (v < float(cur.height));
    const Int8 iu = __builtin_convertvector(inside ? u : Float8{}, Int8);
    const Int8 iv = __builtin_convertvector(inside ? v : Float8{}, Int8);
    const Float8 depth = gathered(cur.depth, iv * cur.width + iu), off = depth - z;
    const Int8 measured = inside & (depth > 0.f);
    const Int8 near = measured & (off < at.gate * z) & (off > -at.gate * z);
    const Float8 sx = (__builtin_convertvector(iu, Float8) - cur.cx) / cur.fx * depth - t[0];
    const Float8 sy = (__builtin_convertvector(iv, Float8) - cur.cy) / cur.fy * depth - t[1], sz = depth - t[2];
    Float8 r = Float8{};
    for (int k = 0; k < 3; ++k)
      r += n[k] * (R[k] * sx + R[3 + k] * sy + R[6 + k] * sz - p[k]);
    r = near ? r : Float8{};
    const Float8 is_near = ones(near), w = weightOf(r * r, at.depth_scale) * is_near;
    equations.add(p, n, w * at.depth_scale, r);
    others[0] += is_near;
    others[1] += w * r * r;
    others[2] += ones(measured);
    others[7] += ones(inside);
    others[8] += ones(near & (r < 3.f) & (r > -3.f));
    if (!cur.gray)
      continue;
    // Intensity: not where another surface is known to be in front or behind.
    const Float8 gz = 1.f / (z + cur.tz);
    const Float8 gu = (q[0] + cur.tx) * gz * cur.gfx + cur.gcx, gv = (q[1] + cur.ty) * gz * cur.gfy + cur.gcy;
    const Int8 shown = real & (near | ~(depth > 0.f)) & inside & (gu >= 0.f) & (gv >= 0.f) &
                       (gu < float(cur.gray_width - 1)) & (gv < float(cur.gray_height - 1));
    const Float8 value = bilinear(cur.gray, cur.gray_width, shown ? gu : Float8{}, shown ? gv : Float8{});
    const Float8 own = load<Float8>(ref.intensity + i);
    const Float8 e = shown ? value - at.gain * own : Float8{};
    const Float8 is_shown = ones(shown), wi = weightOf(e * e, at.gray_scale) * is_shown;
    const Float8 d[3] = {-at.gain * load<Float8>(ref.gx + i), -at.gain * load<Float8>(ref.gy + i),
                         -at.gain * load<Float8>(ref.gz + i)};
    equations.add(p, d, wi * at.gray_scale, e);
    others[3] += is_shown;
    others[4] += wi * e * e;
    others[5] += wi * own * own;
    others[6] += wi * own * value;
  }
  for (int k = 0; k < 27; ++k)
    out.values[k] = total(equations.sums[k]);
  for (int k = 0; k < 9; ++k)
    out.values[27 + k] = total(others[k]);
}

inline constexpr AlignmentKernels kernels = {accumulate};
} // namespace
} // namespace fresco::tracking
