// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "mixed_pixels/beam_window.h"
#include <Eigen/Core>
#include <vector>
namespace fresco::filters {
/// Features of a beam with nearer and farther ones around it: inputs of the networks that tell mixed pixels. They change
/// neither with the frame nor with the unit of length: directions are counted from that in which ranges grow, towards
/// the side with the larger differences.
namespace mixed_pixel_features {
constexpr int bearings = 8, of_bearing = 8, of_window = bearings * of_bearing + 8, of_both = 10;
constexpr int count = 2 * of_window + of_both;
constexpr int rings = 4, of_ring = 16, of_rings = 2 * rings * of_ring;
constexpr int second_stage_count = 2 * count + 1 + 2 * bearings + of_rings + 2;
constexpr float least_score = -8; ///< lower scores count as this: one in 3,000, as good as certain
} // namespace mixed_pixel_features

using MixedPixelFeatures = Eigen::Matrix<float, mixed_pixel_features::count, 1>;
/// Of a beam that has a score: MixedPixelFeatures, the same without beams that score above 0, its score, scores around
/// it, ranges and scores on rings, and how many neighbours of a mixed pixel of this scan are mixed pixels.
using SecondStageFeatures = Eigen::Matrix<float, mixed_pixel_features::second_stage_count, 1>;

/// The windows of a beam and what they are compared with.
struct BeamSurroundings {
  const BeamWindow& near; ///< the nearest beams
  const BeamWindow& wide; ///< beams at least the width of a beam apart, or the nearest again; neither is empty
  float noise;            ///< deviation of the ranges, length, > 0
};

/// Share of the nearer half of the beams around that a surface could join a point with.
/// @param slope way along the beam / way across it that a surface has at most
float joinedShare(const BeamWindow& window, float noise, float slope);

MixedPixelFeatures mixedPixelFeatures(const BeamSurroundings& around);

/// Scores of the nearest beams in 8 directions, of `near`, then of `wide`.
/// @param scores by position
Eigen::Matrix<float, 2 * mixed_pixel_features::bearings, 1> scoresAround(const BeamSurroundings& around,
                                                                         const std::vector<float>& scores);

/// Ranges, then scores, of the beams nearest to 16 places on each of 4 rings, one spacing apart.
Eigen::Matrix<float, mixed_pixel_features::of_rings, 1> ringsAround(const BeamWindow& window, float noise,
                                                                    const std::vector<float>& scores);
} // namespace fresco::filters
