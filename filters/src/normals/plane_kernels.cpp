// SPDX-License-Identifier: BSD-3-Clause
#include "normals/plane_kernels_impl.h"
namespace fresco::filters {
const PlaneKernels& portablePlaneKernels() { return kernels; }

const PlaneKernels& planeKernels()
{
  static const PlaneKernels& fastest = avx2PlaneKernels() ? *avx2PlaneKernels() : kernels;
  return fastest;
}
} // namespace fresco::filters
