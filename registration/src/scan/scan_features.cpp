// SPDX-License-Identifier: BSD-3-Clause
#include "scan/scan_features.h"
#include "scan/fpfh.h"
#include <algorithm>
namespace fresco::registration {
namespace {
// Points in falling order of how much they differ from the mean, each at least `spacing` from those before.
std::vector<Index> distinctivePoints(const ScanLevel& level, const Histograms& histograms, float spacing, Index most)
{
  std::vector<Index> candidates;
  Histogram mean = Histogram::Zero();
  for (Index i = 0; i < histograms.cols(); ++i)
    if (!histograms.col(i).isZero()) {
      candidates.push_back(i);
      mean += histograms.col(i);
    }
  mean.normalize();
  const Eigen::VectorXf likeness = histograms.transpose() * mean;
  std::stable_sort(candidates.begin(), candidates.end(), [&](Index i, Index j) { return likeness[i] < likeness[j]; });
  std::vector<char> blocked(histograms.cols(), 0);
  std::vector<Index> kept;
  std::vector<Neighbor> hits;
  for (const Index i : candidates) {
    if (static_cast<Index>(kept.size()) >= most)
      break;
    if (blocked[i])
      continue;
    kept.push_back(i);
    level.tree->within(level.points.col(i), spacing, hits);
    for (const Neighbor& hit : hits)
      blocked[hit.index] = 1;
  }
  return kept;
}
} // namespace

ScanFeatures describeScan(const PreparedScan& scan, const FeatureOptions& options)
{
  const ScanLevel& level = scan.levels[options.level];
  const Histograms histograms = computeFpfh(level, options.radius * level.voxel, options.threads);
  const std::vector<Index> kept = distinctivePoints(level, histograms, 1.2f * level.voxel, options.most);
  return {level.points(Eigen::all, kept), level.normals(Eigen::all, kept), histograms(Eigen::all, kept),
          findPlanes(scan)};
}
} // namespace fresco::registration
