// SPDX-License-Identifier: BSD-3-Clause
// Compiled for AVX2 (CMakeLists.txt): the kernels run only where the processor has it.
#include "alignment_kernels_impl.h"
namespace fresco::tracking {
const AlignmentKernels* avx2AlignmentKernels()
{
#ifdef __AVX2__
  return __builtin_cpu_supports("avx2") ? &kernels : nullptr;
#else
  return nullptr;
#endif
}
} // namespace fresco::tracking
