// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "experiments/normals_sample.h"
namespace fresco {
/// Least squares planes through those of the k nearest that lie on the same true surface: no choice of neighbours among
/// them can tell the sides of an edge apart better. Where they are fewer than 3, the direction of the beam.
Points sortedByTruth(const NormalSample& sample, const PointTree& tree, int k);

enum class SurfacePlanes {
  exact, ///< those of the room
  fitted ///< least squares planes through the neighbours on each surface, where these are 3 or more
};

/// Each point given to the likeliest of the surfaces of its k nearest (itself included) by its position: the sum of the
/// squares of its deviation across the plane, over that of the noise, and of its distance across the beam to the
/// nearest other point of that surface, over that to the nearest of all, is least. Knows which points share a surface,
/// but not which surface this one lies on.
Points givenToLikeliest(const NormalSample& sample, const PointTree& tree, int k, SurfacePlanes planes);
} // namespace fresco
