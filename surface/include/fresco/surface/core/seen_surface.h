// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <fresco/core/export.h>
#include <fresco/core/mesh.h>
#include <fresco/core/point_stream.h>
namespace fresco {
/// Where sensors saw a surface, and where what they saw ends. A beam confirms the surface that faces it and in whose
/// tangent plane it ended. Around each vertex the beams of one viewpoint are asked, those within an angle of a few
/// beams: the surface ends where the confirming ones lie to one side, as on the border of a half plane, or are outvoted.
/// The level 0 is that border, to a fraction of the distance between beams.
/// @param mesh      faces counter-clockwise seen from the free side
/// @param beams     where beams ended, with their viewpoints; in the world of the mesh, origins may differ. Beams of a
///                  viewpoint come in one window, else each part is asked alone. Non-finite ones are left out.
/// @param tolerance distance from the tangent plane within which a beam ended on it, unit of the mesh, > 0
/// @return V, -1..1: above 0 where the surface was seen, of the viewpoint that saw it best; -1 where none did
/// @throws std::invalid_argument if the mesh is not valid, points have no viewpoints or the tolerance is not positive
FRESCO_EXPORT Eigen::VectorXf seenSurface(const TriangleMesh& mesh, const PointStream& beams, double tolerance,
                                          int threads = 0);
} // namespace fresco
