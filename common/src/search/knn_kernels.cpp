// SPDX-License-Identifier: BSD-3-Clause
#include "search/knn_kernels_impl.h"
namespace fresco::search {
const KnnKernels& portableKnnKernels() { return kernels; }

const KnnKernels& knnKernels() { return avx2KnnKernels() ? *avx2KnnKernels() : kernels; }
} // namespace fresco::search
