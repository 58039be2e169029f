// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan/prepared_scan.h"
#include <array>
#include <optional>
namespace fresco::registration {
constexpr float facing = 0.95f; ///< cosine between a direction and normals that keep to it, 18 degrees

/// How much surface lies across an axis, by the place along it: the square root of the points, in bins.
struct PlaneHistogram {
  Index first = 0; ///< place of the first bin, bins from the frame's origin
  std::vector<float> weights;
};

/// The planes of a scan across three directions at right angles that most of its surfaces keep to, in its working frame.
struct ScanPlanes {
  Eigen::Matrix3f axes = Eigen::Matrix3f::Zero(); ///< columns, a rotation; zero = the scan has no such directions
  float bin = 0.f;                                ///< length
  /// Per axis, of normals against it and along it: both sides of a wall are told apart.
  std::array<std::array<PlaneHistogram, 2>, 3> histograms;
};

ScanPlanes findPlanes(const PreparedScan& scan);

/// Middle of the bin of so much width that holds most places; nothing without places.
std::optional<float> fullestBin(const std::vector<float>& places, float width);
} // namespace fresco::registration
