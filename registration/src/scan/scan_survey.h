// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/registration/core/scan_registration.h>
namespace fresco::registration {
/// What is known of the scans before they are thinned.
struct ScanSurvey {
  std::vector<double> sizes;         ///< see scanSize()
  std::vector<double> voxels;        ///< that suit each scan, length; 0 without points
  std::vector<std::string> problems; ///< why a scan cannot be read; empty = it can
  std::vector<std::uint64_t> hashes; ///< of the points of each scan; 0 without points
  std::vector<std::uint64_t> looks;  ///< likewise, of viewpoints, colours and normals
  std::vector<Index> duplicates;     ///< see findDuplicates()
  double narrowness = 0.0;           ///< mean over the scans that have points, 0..1
};

/// @param ranks that share out the scans
/// @throws std::invalid_argument if an attribute is malformed
ScanSurvey surveyScans(const ScanSource& scans, Exchange& ranks, const ScanRegistrationOptions& options);

/// Per scan without a start pose, another scan that has the same points: one with a start pose, else the first; else -1.
std::vector<Index> findDuplicates(const ScanSurvey& survey, const std::vector<Pose>& start);

/// The median of the scans' sizes, length; 0 if none has any.
/// @throws std::invalid_argument if they differ so much that their units must differ
double commonSize(const std::vector<double>& sizes, const ScanRegistrationOptions& options);

/// Finest thinning of all scans, length.
float chooseVoxel(const ScanSurvey& survey, double size);
} // namespace fresco::registration
