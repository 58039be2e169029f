// SPDX-License-Identifier: BSD-3-Clause
#include "alignment_kernels_impl.h"
namespace fresco::tracking {
const AlignmentKernels& portableAlignmentKernels() { return kernels; }

const AlignmentKernels& alignmentKernels() { return avx2AlignmentKernels() ? *avx2AlignmentKernels() : kernels; }
} // namespace fresco::tracking
