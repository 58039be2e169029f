// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan/prepared_scan.h"
namespace fresco::registration {
/// Sets normals and surface variations of a level by planes through the nearest points; normals point to the points'
/// viewpoints. Surface variation: smallest eigenvalue of the covariance / sum of its eigenvalues (Pauly, Gross, Kobbelt
/// 2002, "Efficient Simplification of Point-Sampled Surfaces").
void estimateNormals(ScanLevel& level, int threads);

/// Points with a normal in an order of which any prefix covers all directions of normals: a direction with m points
/// receives about sqrt(m) of the first places. After the normal-space sampling of Rusinkiewicz & Levoy 2001, "Efficient
/// Variants of the ICP Algorithm": rare directions pin down what common ones leave free.
std::vector<Index> normalSpaceOrder(const ScanLevel& level);
} // namespace fresco::registration
