// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/common/mesh.h>
#include <string>
namespace fresco::volumetric {
/// The part of the mesh where a field, smoothed over it, is at least `least`;
/// triangles are cut along the level line. Gaps smaller than `patch_area` are
/// kept closed, islands smaller than it go. Vertex attributes follow.
/// @param patch_area length^2
TriangleMesh trimMesh(const TriangleMesh& mesh, const std::string& field, float least, double patch_area);
} // namespace fresco::volumetric
