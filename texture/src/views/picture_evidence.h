// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "views/visibility.h"
namespace fresco::texture {
constexpr float one_octave = 20; ///< grey levels of difference that cost an octave: well above noise

/// How far candidates are from what most views show.
struct ColorDifferences {
  std::vector<float> values;    ///< of each candidate, grey levels; -1 where too few views see the patch
  std::vector<float> certainty; ///< of each patch, 0..1
  std::vector<char> at_least;   ///< of each patch: overexposed views agree that it is brighter than the others show
};

/// Differences to expect by the photographs alone: what looks like something nearby that other photographs contradict
/// is a part of it.
/// @return for each candidate; where the certainty is 1 the value that is known
std::vector<float> differencesInPictures(const PatchMesh& patches, const Candidates& candidates,
                                         const ColorDifferences& known, const VisibilityInput& input);
} // namespace fresco::texture
