// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/samples.h"
namespace fresco::poisson {
/// Weight of a point, 1 on average.
struct Weights {
  enum class Source { none, confidences, normal_lengths } source = Source::none;
  double scale = 1.0;

  double of(const PointSet& set, Index i) const;
};

struct Usable {
  Array<std::uint32_t> points;
  Weights weights;
  Cube cube;
};

/// Points that are finite, have a normal and are no far outliers, and the cube around them.
/// @throws std::invalid_argument as reconstructVolumetric()
Usable usablePoints(const PointSet& set, const VolumetricOptions& options);
} // namespace fresco::poisson
