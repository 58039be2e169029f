// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan/scan_features.h"
#include <fresco/registration/core/sc2_pcr.h>
namespace fresco::registration {
/// For each feature of one scan the most similar of the other, in both directions; those that choose each other first,
/// then by distance of their descriptors.
std::vector<Correspondence> matchFeatures(const ScanFeatures& a, const ScanFeatures& b, std::size_t most);

/// Of a scan's own features.
struct SelfMatching {
  std::vector<Index> from; ///< features to match
  float apart = 0.f;       ///< least distance of a match from the feature, length
  float between = 0.f;     ///< least distance of its matches from each other, length
  int count = 1;           ///< matches of each
};

/// For each of the features `from`, the most similar ones of the same scan that lie elsewhere; the most similar pairs
/// first.
std::vector<Correspondence> matchToSelf(const ScanFeatures& features, const SelfMatching& matching);
} // namespace fresco::registration
