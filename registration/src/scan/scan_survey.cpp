// SPDX-License-Identifier: BSD-3-Clause
#include "scan/scan_survey.h"
#include "scan/thinning.h"
#include <algorithm>
#include <fresco/core/require.h>
#include <fresco/core/statistics.h>
namespace fresco::registration {
ScanSurvey surveyScans(const ScanSource& scans)
{
  ScanSurvey survey;
  for (Index i = 0; i < scans.count; ++i) {
    const PointSet scan = scans.read(i);
    validatePointSet(scan);
    survey.sizes.push_back(scanSize(scan));
    survey.narrowness += narrowness(scan) / scans.count;
    const double size = survey.sizes.back();
    survey.voxels.push_back(size > 0.0 ? fittingVoxel(scan, size / voxels_per_size) : 0.0);
  }
  return survey;
}

double commonSize(const std::vector<double>& sizes, const ScanRegistrationOptions& options)
{
  constexpr double size_ratio = 100.0; // between scans of one job: above, one of them is in millimetres
  std::vector<double> known;
  std::copy_if(sizes.begin(), sizes.end(), std::back_inserter(known), [](double size) { return size > 0.0; });
  if (known.empty())
    return 0.0;
  const double middle = rankedValue(known, (known.size() - 1) / 2);
  const Index n = sizes.size();
  for (Index i = 0; i < n; ++i)
    require(!(sizes[i] > 0.0) || (sizes[i] < size_ratio * middle && middle < size_ratio * sizes[i]),
            scanName(options, i), ": reaches ", sizes[i], " from its viewpoint, the others ", middle,
            ": are they in the same unit?");
  return middle;
}

float chooseVoxel(const ScanSurvey& survey, double size)
{
  std::vector<double> voxels;
  for (const double voxel : survey.voxels)
    voxels.push_back(std::max(voxel, size / voxels_per_size));
  return median(voxels);
}
} // namespace fresco::registration
