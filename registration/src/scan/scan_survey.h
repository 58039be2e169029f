// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/registration/core/scan_registration.h>
namespace fresco::registration {
/// What is known of the scans before they are thinned.
struct ScanSurvey {
  std::vector<double> sizes;  ///< see scanSize()
  std::vector<double> voxels; ///< that suit each scan, length
  double narrowness = 0.0;    ///< mean over the scans, 0..1
};

/// @throws std::invalid_argument if an attribute is malformed
ScanSurvey surveyScans(const ScanSource& scans);

/// The median of the scans' sizes, length; 0 if none has any.
/// @throws std::invalid_argument if they differ so much that their units must differ
double commonSize(const std::vector<double>& sizes, const ScanRegistrationOptions& options);

/// Finest thinning of all scans, length.
float chooseVoxel(const ScanSurvey& survey, double size);
} // namespace fresco::registration
