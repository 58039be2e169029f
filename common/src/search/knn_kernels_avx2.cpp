// SPDX-License-Identifier: BSD-3-Clause
// Compiled for AVX2 (CMakeLists.txt): the kernels run only where the processor has it.
#include "search/knn_kernels_impl.h"
namespace fresco::search {
const KnnKernels* avx2KnnKernels()
{
#ifdef __AVX2__
  return __builtin_cpu_supports("avx2") ? &kernels : nullptr;
#else
  return nullptr;
#endif
}
} // namespace fresco::search
