// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "mixed_pixels/beam_scan.h"
#include <optional>
#include <vector>
namespace fresco::filters {
/// The neighbouring beams of one beam, nearest first, where those of a plane lie on a plane again: in the plane
/// perpendicular to the beam at distance 1, with one over the depth along the beam as height.
struct BeamWindow {
  struct Beam {
    Eigen::Vector2f place;      ///< in units of `spacing`
    Eigen::Vector2f way;        ///< direction of `place`, unit
    float inverse_depth, range; ///< 1 / length, length
    int position;               ///< in the scan
    float sideways;             ///< length, way across the beams at the nearer of both ranges
  };
  std::vector<Beam> beams;
  float spacing = 0; ///< radians between neighbouring beams
  float range = 0;   ///< of the beam in the middle
};

void fillWindow(const BeamScan& scan, Index i, const int* first, const int* last, BeamWindow& window);

/// Range at which a plane through neighbouring beams meets the beam in the middle.
struct Continuation {
  float range = 0;
  float deviation = 0; ///< of the measured range against it, length
};

/// A part of a window.
struct WindowSide {
  Eigen::Vector2f way; ///< to its middle, unit
  float least_cosine;  ///< between `way` and the ways to its beams
  int most;            ///< nearest beams that count
};

/// Least squares plane of the beams of a side, without up to a third that lies off it. Noise is taken to grow with
/// 1 / sqrt(cosine of incidence), up to threefold.
/// @return nothing where fewer than 4 beams are there, they do not lie on a plane, or it is met at more than 87 degrees
std::optional<Continuation> continueSide(const BeamWindow& window, const WindowSide& side, float noise);

/// From the differences to the planes through the beams around, of which depth jumps and bends spoil few. Half of them
/// lie within 0.6745 deviations. Scanners that round their ranges make that zero; the third quarter, half of its value
/// to be safe from bends, tells then. Up to 16 groups of beams of similar range are judged apart.
RangeNoise measureNoise(const BeamScan& scan, int threads);
} // namespace fresco::filters
