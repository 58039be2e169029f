// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "views/visibility.h"
namespace fresco::texture {
/// Lenses, see calibrateLenses(); then a factor per view and channel that makes the views agree: least squares over the
/// median ratio of each pair of views. Both are robust against what disagrees with the rest. Means of the factors'
/// logarithms are 0; nothing is corrected where nothing is known.
/// @param lenses of each view, see lensNumbers()
/// @param owner per candidate view what it is a part of: parts of one have the same factor
Photometry solvePhotometry(const Candidates& candidates, const std::vector<int>& lenses, const std::vector<int>& owner);

/// Fills gains, vignetting and response of the result's `views`, of which the parts of a panorama share them.
void describePhotometry(const Photometry& photometry, const std::vector<int>& owner, Index views,
                        TextureResult& result);

/// The factors alone.
Points solveGains(const Candidates& candidates, const std::vector<int>& owner);
} // namespace fresco::texture
