// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/deliverables/core/plan.h>
namespace fresco::plan {
/// Faces share vertices, see weldedFaces().
struct MeshToCut {
  Points vertices;
  Faces faces;
};

/// cutMesh() without its checks.
std::vector<Eigen::Matrix3Xd> cutLines(const MeshToCut& mesh, const Eigen::Vector3d& axis, double offset);
} // namespace fresco::plan
