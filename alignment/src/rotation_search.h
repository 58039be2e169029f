// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan_surface.h"
#include "sparse_model.h"
namespace fresco::alignment {
/// Rotations that bring the directions of the model's normals onto those of the surface, most likely first, distinct.
std::vector<Eigen::Matrix3d> findRotations(const SparseModel& model, const ScanSurface& surface, int threads);
} // namespace fresco::alignment
