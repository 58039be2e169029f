// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "evidence/frame_judge.h"
namespace fresco::registration {
/// Which scans share a frame, and how they lie in it.
struct Arrangement {
  std::vector<ScanCluster> frames; ///< every scan in one of them
  double log_odds = 0.0;           ///< sum over the frames
};

struct SearchOptions {
  std::size_t beam = 6;   ///< arrangements that are kept from join to join
  double tolerance = 0.0; ///< relative poses nearer to each other are one place, length
  double hopeless = -8.0; ///< log-odds of a pair below which its place is not tried
};

/// The arrangement that explains the scans best, of those that proposed places make up: best-first joins with a beam, then
/// exchange of scans and parts of frames. From n scans alone, at most n joins; each tries all places that are left.
Arrangement findArrangement(FrameJudge& judge, const ProposedPlaces& places, const SearchOptions& options);

/// Some scans of a frame, and by how much the arrangement is likelier than the best other one, in which they are apart from
/// the rest or elsewhere.
struct PartMargin {
  std::size_t frame = 0;
  std::vector<Index> scans; ///< at most half of the frame's
  double margin = 0.0;      ///< log-odds
};

/// Of every single scan, and of every part that holds together most.
std::vector<PartMargin> findMargins(FrameJudge& judge, const ProposedPlaces& places, const SearchOptions& options,
                                    const Arrangement& arrangement);

/// Cuts off parts, the least certain first, until the place of each scan in its frame is as certain as wanted.
/// @param least margin, log-odds
Arrangement keepCertain(FrameJudge& judge, const ProposedPlaces& places, const SearchOptions& options,
                        Arrangement arrangement, double least);
} // namespace fresco::registration
