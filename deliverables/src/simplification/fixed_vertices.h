// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/deliverables/core/simplification.h>
#include <vector>
namespace fresco::deliverables {
/// simplifyMesh() that leaves some vertices as they are.
/// @param fixed V
TriangleMesh simplifyBetween(const std::vector<bool>& fixed, TriangleMesh mesh, const SimplificationOptions& options,
                             SimplificationFigures& figures);
} // namespace fresco::deliverables
