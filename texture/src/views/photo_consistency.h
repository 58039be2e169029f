// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "views/visibility.h"
namespace fresco::texture {
/// Cost in octaves of resolution for every candidate, in the order of candidates.list: high where its colour differs
/// from what most views of the patch show, because something stood in the way, moved or shone there, and where it is
/// overexposed.
/// @param gains 3xV, factor per view and channel
std::vector<float> oddityCosts(const PatchMesh& patches, const Candidates& candidates, const Points& gains,
                               int threads);
} // namespace fresco::texture
