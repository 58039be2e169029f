// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "views/visibility.h"
namespace fresco::texture {
/// How far each candidate is to be believed, in the order of candidates.list.
struct PhotoConsistency {
  /// Octaves of resolution that its view loses. High where its colour differs from what most views of the patch show:
  /// something stood in the way, moved or shone there, and where it is blurred beside others. Overexposed candidates lose to all others.
  std::vector<float> penalties;
  /// Whether it shows what does not belong to the surface, though too few views see the patch to contradict: the
  /// photograph beside it shows the like where others do contradict.
  std::vector<char> foreign;
};

PhotoConsistency photoConsistency(const PatchMesh& patches, const Candidates& candidates, const Photometry& photometry,
                                  const VisibilityInput& input);
} // namespace fresco::texture
