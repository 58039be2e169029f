// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/mesh.h>
namespace fresco::benchmark {
/// Closed shapes with sharp edges, of about one unit; faces counter-clockwise from outside.
TriangleMesh boxWithHole(); ///< box 1 x 1 x 0.6 with a cylindrical hole of radius 0.3 through it
TriangleMesh gear();        ///< 12 teeth, radii 0.4 and 0.5, 0.25 thick
TriangleMesh staircase();   ///< five steps; each tread is a plate 0.04 thick that overhangs
} // namespace fresco::benchmark
