// SPDX-License-Identifier: BSD-3-Clause
#include "fusion/vote_kernels_impl.h"
namespace fresco::fusion {
const VoteKernels& portableVoteKernels() { return kernels; }

const VoteKernels& voteKernels() { return avx2VoteKernels() ? *avx2VoteKernels() : kernels; }
} // namespace fresco::fusion
