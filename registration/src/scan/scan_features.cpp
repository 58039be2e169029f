// SPDX-License-Identifier: BSD-3-Clause
#include "scan/scan_features.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/constants.h>
#include <fresco/core/parallel.h>
namespace fresco::registration {
namespace {
constexpr int fpfh_bins = 11; // per angle, as in Rusu et al. 2009
using Histogram = Eigen::Matrix<float, 3 * fpfh_bins, 1>;
using Histograms = Eigen::Matrix<float, 3 * fpfh_bins, Eigen::Dynamic>;

struct OrientedPoint {
  Eigen::Vector3f position, normal;
};

OrientedPoint orientedPoint(const ScanLevel& level, Index i) { return {level.points.col(i), level.normals.col(i)}; }

int binOf(float value, float low, float high)
{
  return std::clamp(static_cast<int>((value - low) / (high - low) * fpfh_bins), 0, fpfh_bins - 1);
}

// Adds the three angles between two oriented points to a histogram; of the two, the source is the one whose normal lies
// closer to the line between them.
void addPair(const OrientedPoint& first, const OrientedPoint& second, Histogram& histogram)
{
  Eigen::Vector3f d = second.position - first.position;
  const float length = d.norm();
  if (!(length > 0.f))
    return;
  d /= length;
  const bool swap = std::abs(first.normal.dot(d)) < std::abs(second.normal.dot(d));
  const Eigen::Vector3f &u = swap ? second.normal : first.normal, &n = swap ? first.normal : second.normal;
  if (swap)
    d = -d;
  Eigen::Vector3f v = d.cross(u);
  const float norm = v.norm();
  if (!(norm > 1e-6f))
    return;
  v /= norm;
  const Eigen::Vector3f w = u.cross(v);
  const float half_turn = pi;
  histogram[binOf(v.dot(n), -1.f, 1.f)] += 1.f;
  histogram[fpfh_bins + binOf(u.dot(d), -1.f, 1.f)] += 1.f;
  histogram[2 * fpfh_bins + binOf(std::atan2(w.dot(n), u.dot(n)), -half_turn, half_turn)] += 1.f;
}

void normalizeParts(Histogram& histogram)
{
  for (int part = 0; part < 3; ++part) {
    auto block = histogram.segment<fpfh_bins>(part * fpfh_bins);
    const float sum = block.sum();
    if (sum > 0.f)
      block /= sum;
  }
}

// Simplified point feature histogram of a point.
Histogram spfh(const ScanLevel& level, Index i, const std::vector<Neighbor>& neighbors)
{
  Histogram histogram = Histogram::Zero();
  const OrientedPoint point = orientedPoint(level, i);
  for (const Neighbor& hit : neighbors)
    if (hit.index != i && !level.normals.col(hit.index).isZero())
      addPair(point, orientedPoint(level, hit.index), histogram);
  normalizeParts(histogram);
  return histogram;
}

// Fast point feature histograms of all points of a level (Rusu, Blodow, Beetz 2009, "Fast Point Feature Histograms
// (FPFH) for 3D Registration"): simplified histograms of three angles (SPFH), then FPFH = SPFH + sum of the
// neighbours' SPFH, each by 1 / distance. Unlike there, each column is the square root of the histogram and has unit
// length, so that products of columns compare histograms (Bhattacharyya coefficient). Zero where there is no normal.
// @param radius of the neighbourhood, length
Histograms computeFpfh(const ScanLevel& level, float radius, int threads)
{
  const Index n = level.points.cols();
  Histograms simplified = Histograms::Zero(3 * fpfh_bins, n), full(3 * fpfh_bins, n);
  std::vector<std::vector<Neighbor>> neighbors(n);
  parallelFor(n, threads, [&](Index i) {
    if (level.normals.col(i).isZero())
      return;
    level.tree->within(level.points.col(i), radius, neighbors[i]);
    simplified.col(i) = spfh(level, i, neighbors[i]);
  });
  parallelFor(n, threads, [&](Index i) {
    Histogram sum = Histogram::Zero();
    for (const Neighbor& hit : neighbors[i])
      if (hit.index != i)
        sum += simplified.col(hit.index) / std::sqrt(std::max(hit.squared_distance, 1e-12f));
    normalizeParts(sum);
    Histogram histogram = simplified.col(i) + sum;
    normalizeParts(histogram);
    full.col(i) = (histogram / 3.f).cwiseSqrt();
  });
  return full;
}

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

ScanFeatures describeScan(const PreparedScan& scan, int threads)
{
  constexpr Index most = 1200;
  constexpr float radius = 5.f; // of the neighbourhood that is described, voxels
  const ScanLevel& level = scan.levels[1];
  const Histograms histograms = computeFpfh(level, radius * level.voxel, threads);
  const std::vector<Index> kept = distinctivePoints(level, histograms, 1.2f * level.voxel, most);
  return {level.points(Eigen::all, kept), level.normals(Eigen::all, kept), histograms(Eigen::all, kept),
          findPlanes(scan)};
}
} // namespace fresco::registration
