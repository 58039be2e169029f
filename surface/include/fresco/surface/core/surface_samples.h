// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <fresco/core/export.h>
#include <fresco/core/mesh.h>
namespace fresco {
/// Points spread over a surface.
struct SurfaceSamples {
  Eigen::Matrix3Xd points; ///< 3xN, in the frame of the vertices
  Eigen::VectorXi faces;   ///< N, the face each lies on, ascending
};

/// Area-uniform random points: each of `count` strips of equal area holds one, uniform within its face (Osada et al.
/// 2002, "Shape distributions", eq. 1). The same seed gives the same points on every machine and for any number of
/// threads.
/// @throws std::invalid_argument if `count` is not positive, the mesh is not valid or its area is zero
FRESCO_EXPORT SurfaceSamples sampleSurface(const TriangleMesh& mesh, Index count, std::uint64_t seed, int threads = 0);
} // namespace fresco
