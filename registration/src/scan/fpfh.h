// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "scan/prepared_scan.h"
namespace fresco::registration {
constexpr int fpfh_bins = 11; ///< per angle, as in Rusu et al. 2009
using Histogram = Eigen::Matrix<float, 3 * fpfh_bins, 1>;
using Histograms = Eigen::Matrix<float, 3 * fpfh_bins, Eigen::Dynamic>;

/// Fast point feature histograms of all points of a level (Rusu, Blodow, Beetz 2009, "Fast Point Feature Histograms
/// (FPFH) for 3D Registration"): simplified histograms of three angles (SPFH), then FPFH = SPFH + sum of the
/// neighbours' SPFH, each by 1 / distance. Unlike there, each column is the square root of the histogram and has unit
/// length, so that products of columns compare histograms (Bhattacharyya coefficient). Zero where there is no normal.
/// @param radius of the neighbourhood, length
Histograms computeFpfh(const ScanLevel& level, float radius, int threads);
} // namespace fresco::registration
