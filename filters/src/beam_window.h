// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/filters/core/neighbors.h>
#include <memory>
#include <optional>
#include <vector>
namespace fresco {
/// What one viewpoint sees, in the order of a tree over directions.
struct BeamScan {
  std::vector<Index> columns; ///< of the input
  Points directions;          ///< unit
  Eigen::VectorXf ranges;
  NeighborLists lists;             ///< nearest beams by angle, the beam itself included
  std::unique_ptr<PointTree> tree; ///< of all directions, where lists leave out some between
  float noise = 0;                 ///< deviation of the ranges, length
};

/// The neighbouring beams of one beam, nearest first, where those of a plane lie on a plane again: in the plane
/// perpendicular to the beam at distance 1, with one over the depth along the beam as height.
struct BeamWindow {
  struct Beam {
    Eigen::Vector2f place;      ///< in units of `spacing`
    float bearing;              ///< radians, of `place`
    float inverse_depth, range; ///< 1 / length, length
    float sideways;             ///< length, way across the beams at the nearer of both ranges
  };
  std::vector<Beam> beams;
  float spacing = 0; ///< radians to the nearest beam
  float range = 0;   ///< of the beam in the middle
};

void fillWindow(const BeamScan& scan, Index i, BeamWindow& window);

/// Range at which a plane through neighbouring beams meets the beam in the middle.
struct Continuation {
  float range = 0;
  float deviation = 0; ///< of the measured range against it, length
};

/// Least squares plane of the `most` nearest beams whose bearing differs from `bearing` by no more than `reach`,
/// without up to a third that lies off it. Noise is taken to grow with 1 / sqrt(cosine of incidence), up to threefold.
/// @return nothing where fewer than 4 beams are there, they do not lie on a plane, or it is met at more than 87 degrees
std::optional<Continuation> continueSide(const BeamWindow& window, float bearing, float reach, int most, float noise);

/// Deviation of the ranges of a scan: from the differences to the planes through the beams around, of which depth jumps
/// and bends spoil few. Half of them lie within 0.6745 deviations. Scanners that round their ranges make that zero; the
/// third quarter, half of its value to be safe from bends, tells then.
float measureNoise(const BeamScan& scan, int threads);
} // namespace fresco
