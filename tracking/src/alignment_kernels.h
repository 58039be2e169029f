// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
namespace fresco::tracking {
/// Points of a reference frame, as separate arrays of a length that is a multiple of 8. Padding: z = 1, all else 0.
struct ReferenceArrays {
  const float *x, *y, *z;    ///< metres
  const float *nx, *ny, *nz; ///< unit normal / deviation of the depth there, 1/metre; 0 0 0 = padding
  const float *gx, *gy, *gz; ///< gradient of the intensity over the point's motion, grey levels a metre
  const float* intensity;    ///< 0..255
};

/// The images of the other frame.
struct CurrentArrays {
  const float *depth, *gray; ///< rows from the top; 0 = no depth; gray may be null
  int width, height, gray_width, gray_height;
  float fx, fy, cx, cy;     ///< of the depth image, pixel centres at integers
  float gfx, gfy, gcx, gcy; ///< of the intensities
  float tx, ty, tz;         ///< colour camera from depth camera
};

/// Where the alignment is.
struct Linearization {
  float R[9], t[3];  ///< current from reference, rows
  float gate;        ///< difference of depths from which another surface is seen, share of the depth
  float gain;        ///< current intensity / reference intensity
  float depth_scale; ///< 1 / variance of the depth residuals, which are in units of their expected deviation
  float gray_scale;  ///< 1 / variance of the intensity residuals
};

/// Sums over a range of points.
struct AlignmentSums {
  static constexpr int count = 21 + 6 + 9;
  /// Upper triangle of H by rows, b, then: points with a depth residual; w r^2 of these; points whose place has a depth;
  /// points with an intensity residual; w r^2 of these; w i i, w i j (i reference, j current); points within the
  /// image; those whose depth residual is within three deviations.
  float values[count];
};

/// Robust normal equations of both residuals; weights of a t distribution with 5 degrees of freedom.
struct AlignmentKernels {
  void (*accumulate)(const ReferenceArrays& reference, std::size_t begin, std::size_t end, const CurrentArrays& current,
                     const Linearization& at, AlignmentSums& sums);
};

const AlignmentKernels& alignmentKernels();         ///< the fastest ones that this processor runs
const AlignmentKernels& portableAlignmentKernels(); ///< those that run everywhere
const AlignmentKernels* avx2AlignmentKernels();     ///< null where the processor has no AVX2
} // namespace fresco::tracking
