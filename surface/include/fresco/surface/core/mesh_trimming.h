// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/mesh.h>
namespace fresco {
/// The part of a mesh where `values`, smoothed over it, are at least `least`; triangles are cut along the level line.
/// Gaps smaller than `patch_area` are kept closed, islands smaller than it go. Vertex attributes follow.
/// @param values     V, finite
/// @param patch_area unit of the vertices squared, >= 0
/// @param rounds     in which each value becomes the mean of its own and those around, >= 0
/// @throws std::invalid_argument if there is not one value per vertex
FRESCO_EXPORT TriangleMesh trimMesh(const TriangleMesh& mesh, Eigen::VectorXf values, float least, double patch_area,
                                    int rounds = 4);
} // namespace fresco
