// SPDX-License-Identifier: BSD-3-Clause
// Compiled for AVX2 (CMakeLists.txt): the kernels run only where the processor has it.
#include "fusion/vote_kernels_impl.h"
namespace fresco::fusion {
const VoteKernels* avx2VoteKernels()
{
#ifdef __AVX2__
  return __builtin_cpu_supports("avx2") ? &kernels : nullptr;
#else
  return nullptr;
#endif
}
} // namespace fresco::fusion
