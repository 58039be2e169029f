// SPDX-License-Identifier: BSD-3-Clause
#include "scan/scan_features.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <numeric>
namespace fresco::registration {
namespace {
constexpr int bins = 11; // per angle
using Histogram = Eigen::Matrix<float, 3 * bins, 1>;
using Histograms = Eigen::Matrix<float, 3 * bins, Eigen::Dynamic>;

int binOf(float value, float low, float high)
{
  return std::clamp(static_cast<int>((value - low) / (high - low) * bins), 0, bins - 1);
}

// Adds the three angles between two oriented points to a histogram; of the two, the source is the one whose normal lies
// closer to the line between them.
void addPair(const Eigen::Vector3f& p1, const Eigen::Vector3f& n1, const Eigen::Vector3f& p2, const Eigen::Vector3f& n2,
             Histogram& histogram)
{
  Eigen::Vector3f d = p2 - p1;
  const float length = d.norm();
  if (!(length > 0.f))
    return;
  d /= length;
  const bool swap = std::abs(n1.dot(d)) < std::abs(n2.dot(d));
  const Eigen::Vector3f &u = swap ? n2 : n1, &n = swap ? n1 : n2;
  if (swap)
    d = -d;
  Eigen::Vector3f v = d.cross(u);
  const float norm = v.norm();
  if (!(norm > 1e-6f))
    return;
  v /= norm;
  const Eigen::Vector3f w = u.cross(v);
  const float pi = M_PI;
  histogram[binOf(v.dot(n), -1.f, 1.f)] += 1.f;
  histogram[bins + binOf(u.dot(d), -1.f, 1.f)] += 1.f;
  histogram[2 * bins + binOf(std::atan2(w.dot(n), u.dot(n)), -pi, pi)] += 1.f;
}

void normalizeParts(Histogram& histogram)
{
  for (int part = 0; part < 3; ++part) {
    auto block = histogram.segment<bins>(part * bins);
    const float sum = block.sum();
    if (sum > 0.f)
      block /= sum;
  }
}

// Simple histograms of all points, then each blended with those of its neighbours by distance.
Histograms describePoints(const ScanLevel& level, float radius, int threads)
{
  const Index n = level.points.cols();
  Histograms simple = Histograms::Zero(3 * bins, n), full(3 * bins, n);
  std::vector<std::vector<Neighbor>> neighbors(n);
  parallelFor(n, threads, [&](Index i) {
    auto& hits = neighbors[i];
    if (level.normals.col(i).isZero())
      return;
    level.tree->within(level.points.col(i), radius, hits);
    Histogram histogram = Histogram::Zero();
    for (const Neighbor& hit : hits)
      if (hit.index != i && !level.normals.col(hit.index).isZero())
        addPair(level.points.col(i), level.normals.col(i), level.points.col(hit.index), level.normals.col(hit.index),
                histogram);
    normalizeParts(histogram);
    simple.col(i) = histogram;
  });
  parallelFor(n, threads, [&](Index i) {
    Histogram sum = Histogram::Zero();
    for (const Neighbor& hit : neighbors[i])
      if (hit.index != i)
        sum += simple.col(hit.index) / std::sqrt(std::max(hit.squared_distance, 1e-12f));
    normalizeParts(sum);
    Histogram histogram = simple.col(i) + sum;
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

// Column of the most similar descriptor of `b` for each of `a`, and the likeness, 0..1.
std::vector<std::pair<Index, float>> mostSimilar(const Eigen::MatrixXf& likeness)
{
  std::vector<std::pair<Index, float>> best(likeness.cols());
  for (Index i = 0; i < likeness.cols(); ++i) {
    Index row = 0;
    const float value = likeness.col(i).maxCoeff(&row);
    best[i] = {row, value};
  }
  return best;
}
} // namespace

ScanFeatures describeScan(const PreparedScan& scan, const FeatureOptions& options)
{
  const ScanLevel& level = scan.levels[options.level];
  const Histograms histograms = describePoints(level, options.radius * level.voxel, options.threads);
  const std::vector<Index> kept = distinctivePoints(level, histograms, 1.2f * level.voxel, options.most);
  return {level.points(Eigen::all, kept), level.normals(Eigen::all, kept), histograms(Eigen::all, kept)};
}

std::vector<Correspondence> matchFeatures(const ScanFeatures& a, const ScanFeatures& b, std::size_t most)
{
  if (a.points.cols() == 0 || b.points.cols() == 0)
    return {};
  const Eigen::MatrixXf likeness = b.descriptors.transpose() * a.descriptors;
  const auto forward = mostSimilar(likeness), backward = mostSimilar(likeness.transpose());
  struct Ranked {
    bool single;
    float likeness;
    Correspondence match;
  };
  std::vector<Ranked> ranked;
  for (Index i = 0; i < a.points.cols(); ++i) {
    const auto [j, value] = forward[i];
    ranked.push_back({backward[j].first != i, value, {i, j}});
  }
  for (Index j = 0; j < b.points.cols(); ++j) {
    const auto [i, value] = backward[j];
    if (forward[i].first != j)
      ranked.push_back({true, value, {i, j}});
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const Ranked& x, const Ranked& y) {
    return x.single != y.single ? y.single : x.likeness > y.likeness;
  });
  std::vector<Correspondence> matches;
  for (std::size_t k = 0; k < std::min(most, ranked.size()); ++k)
    matches.push_back(ranked[k].match);
  return matches;
}
} // namespace fresco::registration
