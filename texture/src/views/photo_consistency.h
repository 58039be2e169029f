// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "views/visibility.h"
namespace fresco::texture {
/// Penalty in octaves of resolution for every candidate, in the order of candidates.list. It is high where the colour
/// differs from what most views of the patch show: something stood in the way, moved or shone there. Overexposed
/// candidates get one octave more.
std::vector<float> photoConsistencyPenalties(const PatchMesh& patches, const Candidates& candidates,
                                             const Photometry& photometry, int threads);
} // namespace fresco::texture
