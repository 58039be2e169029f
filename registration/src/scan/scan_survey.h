// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/registration/core/scan_registration.h>
namespace fresco::registration {
/// What is known of a scan before it is thinned.
struct ScanSketch {
  std::string problem;     ///< why it cannot be read; empty = it can
  double size = 0.0;       ///< see scanSize()
  double narrowness = 0.0; ///< see narrowness()
  double voxel = 0.0;      ///< that suits it, length; 0 without points
  std::uint64_t hash = 0;  ///< of its points; 0 without points
  std::uint64_t look = 0;  ///< of its viewpoints, colours and normals
  bool has_points = false;
};

struct ScanSurvey {
  std::vector<ScanSketch> scans;
  std::vector<Index> duplicates; ///< see findDuplicates()
  double narrowness = 0.0;       ///< mean over the scans that have points, 0..1
};

/// @param ranks that share out the scans
/// @throws std::invalid_argument if an attribute is malformed
ScanSurvey surveyScans(const ScanSource& scans, Exchange& ranks, const ScanRegistrationOptions& options);

/// Per scan without a start pose, another scan that has the same points: one with a start pose, else the first; else -1.
std::vector<Index> findDuplicates(const ScanSurvey& survey, const std::vector<Pose>& start);

/// The median of the scans' sizes, length; 0 if none has any.
/// @throws std::invalid_argument if they differ so much that their units must differ
double commonSize(const ScanSurvey& survey, const ScanRegistrationOptions& options);

/// Finest thinning of all scans, length.
float chooseVoxel(const ScanSurvey& survey, double size);
} // namespace fresco::registration
