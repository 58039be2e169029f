// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "graph/alignment_state.h"
#include <fresco/core/progress.h>
namespace fresco::registration {
/// What all graphs of a registration go by.
GraphOptions graphOptions(const ScanRegistrationOptions& options);

/// Joins scans without start poses to clusters in common frames. Pairs that look most alike are tried first; once all
/// scans hang together, no more are.
/// A scan of narrow view that contradicts most of its pairs by its free space has another viewpoint than was thought:
/// distrustViewpoint() is called on it.
GlobalAlignment alignGlobally(const AlignmentInput& input, const ScanRegistrationOptions& options,
                              const Progress& progress);
} // namespace fresco::registration
