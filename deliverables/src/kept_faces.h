// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/textured_mesh.h>
#include <vector>
namespace fresco::deliverables {
/// A model without its other faces, and without vertices and texture coordinates that no face names then.
/// @param keep F
void keepFaces(const std::vector<bool>& keep, TexturedMesh& model);
} // namespace fresco::deliverables
