// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/samples.h"
#include "poisson/cube.h"
#include "poisson/octree/radix_sort.h"
#include "poisson/octree/select.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/morton.h>
#include <fresco/core/parallel.h>
#include <fresco/core/release.h>
#include <fresco/core/require.h>
namespace fresco::poisson {
namespace {
std::uint64_t cellCode(const Eigen::Vector3f& cell, int depth)
{
  const float last = (1 << depth) - 1;
  const Eigen::Vector3i c = cell.cwiseMax(0.f).cwiseMin(last).cast<int>();
  return mortonCode(c.x(), c.y(), c.z());
}

Eigen::Vector3f toCells(const PointSet& set, Index i, const Cube& cube)
{
  return ((set.points.col(i).cast<double>() - cube.corner) / cube.cell()).cast<float>();
}

/// Usable points in the order of their cells. Cell code and point index share 64 bits; where they do not fit, the
/// lowest bits of the code are left out and made up for by sorting the few points that then look alike.
class SortedPoints {
public:
  SortedPoints(const PointSet& set, const Array<std::uint32_t>& usable, const Cube& cube, int threads)
      : set_(set), cube_(cube)
  {
    while (set.size() >> index_bits_ != 0)
      ++index_bits_;
    const int code_bits = std::min(3 * cube.depth, 64 - index_bits_);
    dropped_bits_ = 3 * cube.depth - code_bits;
    keys_.resize(usable.size());
    parallelFor(usable.size(), threads, [&](Index k) {
      const std::uint32_t i = usable[k];
      keys_[k] = codeOf(i) >> dropped_bits_ << index_bits_ | i;
    });
    sortBits(keys_, index_bits_, code_bits, threads);
    if (dropped_bits_ > 0)
      sortLowBits();
  }

  Index size() const { return keys_.size(); }
  Index point(Index k) const { return indexOf(keys_[k]); }
  std::uint64_t code(Index k) const { return dropped_bits_ > 0 ? codeOf(point(k)) : keys_[k] >> index_bits_; }

private:
  Index indexOf(std::uint64_t key) const { return key & ((std::uint64_t(1) << index_bits_) - 1); }
  std::uint64_t codeOf(Index i) const { return cellCode(toCells(set_, i, cube_), cube_.depth); }

  void sortLowBits()
  {
    const auto order = [&](std::uint64_t a, std::uint64_t b) {
      const std::uint64_t code_a = codeOf(indexOf(a)), code_b = codeOf(indexOf(b));
      return code_a != code_b ? code_a < code_b : a < b;
    };
    for (std::size_t begin = 0, end = 0; begin < keys_.size(); begin = end) {
      while (end < keys_.size() && keys_[end] >> index_bits_ == keys_[begin] >> index_bits_)
        ++end;
      std::sort(keys_.begin() + begin, keys_.begin() + end, order);
    }
  }

  const PointSet& set_;
  const Cube& cube_;
  int index_bits_ = 1, dropped_bits_ = 0;
  Array<std::uint64_t> keys_;
};

struct Sums {
  Eigen::Vector3d position = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
  Eigen::Vector4d attributes = Eigen::Vector4d::Zero();
  double weight = 0;
};

Attributes attributesOf(const PointSet& set, Index i)
{
  Attributes a = Attributes::Zero();
  if (set.colors.cols() > 0)
    a.head<3>() = set.colors.col(i).cast<float>();
  if (set.intensities.size() > 0)
    a[3] = set.intensities[i];
  return a;
}

Sums sumCell(const PointSet& set, const Weights& weights, const SortedPoints& points, Index begin, Index end)
{
  Sums sums;
  for (Index k = begin; k < end; ++k) {
    const Index i = points.point(k);
    const double w = weights.of(set, i);
    sums.weight += w;
    sums.position += w * set.points.col(i).cast<double>();
    sums.normal += w * set.normals.col(i).cast<double>().normalized();
    sums.attributes += w * attributesOf(set, i).cast<double>();
  }
  return sums;
}
} // namespace

Samples gatherSamples(const PointSet& set, const VolumetricOptions& options)
{
  Samples result;
  require(set.size() < Index(1) << 32, "volumetric reconstruction: ", set.size(), " points are more than 2^32");
  Usable usable = usablePoints(set, options);
  result.cube = usable.cube;
  result.used_points = usable.points.size();
  result.left_out_points = set.size() - result.used_points;
  const SortedPoints points(set, usable.points, result.cube, options.threads);
  releaseMemory(usable.points);
  const auto codeAt = [&](Index k) { return points.code(k); };
  const Array<std::uint32_t> runs = runBegins(points.size(), options.threads, codeAt);
  const std::size_t n = runs.size() - 1;
  result.codes.resize(n);
  result.samples.resize(n);
  if (set.colors.cols() > 0 || set.intensities.size() > 0)
    result.attributes.resize(n);
  parallelFor(n, options.threads, [&](Index i) {
    const Sums sums = sumCell(set, usable.weights, points, runs[i], runs[i + 1]);
    result.codes[i] = points.code(runs[i]);
    Sample& sample = result.samples[i];
    sample.position = ((sums.position / sums.weight - result.cube.corner) / result.cube.cell()).cast<float>();
    const double length = sums.normal.norm();
    sample.normal = (sums.normal / std::max(length, 1e-12)).cast<float>();
    sample.area = sums.weight;
    sample.depth = sample.noise = 0.f;
    if (!result.attributes.empty())
      result.attributes[i] = (sums.attributes / sums.weight).cast<float>();
  });
  return result;
}

SampleLevel finestLevel(const Samples& samples, int threads)
{
  SampleLevel level;
  level.depth = samples.cube.depth;
  level.codes.resize(samples.codes.size());
  level.samples.resize(samples.samples.size());
  parallelFor(samples.samples.size(), threads, [&](Index i) {
    const Sample& s = samples.samples[i];
    level.codes[i] = samples.codes[i];
    level.samples[i] = {s.position, s.area, s.noise, s.depth};
  });
  return level;
}

SampleLevel coarsen(const SampleLevel& fine, int threads)
{
  const auto parentOf = [&](Index i) { return fine.codes[i] >> 3; };
  const Array<std::uint32_t> runs = runBegins(fine.codes.size(), threads, parentOf);
  SampleLevel coarse;
  coarse.depth = fine.depth - 1;
  coarse.codes.resize(runs.size() - 1);
  coarse.samples.resize(runs.size() - 1);
  parallelFor(coarse.codes.size(), threads, [&](Index c) {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    double area = 0, variance = 0, depth = 0;
    for (std::uint32_t i = runs[c]; i < runs[c + 1]; ++i) {
      const CoarseSample& s = fine.samples[i];
      position += s.area * s.position.cast<double>();
      area += s.area;
      depth += s.area * s.depth;
      variance += std::pow(s.area * s.noise, 2);
    }
    coarse.codes[c] = parentOf(runs[c]);
    CoarseSample& joined = coarse.samples[c];
    joined.position = (position / area).cast<float>();
    joined.area = area;
    joined.noise = std::sqrt(variance) / area;
    joined.depth = depth / area;
  });
  return coarse;
}

Array<std::uint32_t> sampleRanges(const BrickLevel& level, const Array<std::uint64_t>& codes, int depth, int threads)
{
  const int shift = 3 * (depth - level.depth + 2);
  Array<std::uint32_t> begin(level.codes.size() + 1);
  parallelRanges(level.size(), threads, [&](Index first, Index last) {
    const auto isBefore = [&](std::uint64_t code, std::uint64_t brick) { return code >> shift < brick; };
    auto at = std::lower_bound(codes.begin(), codes.end(), level.codes[first], isBefore);
    for (Index b = first; b < last; ++b) {
      while (at != codes.end() && isBefore(*at, level.codes[b]))
        ++at;
      begin[b] = at - codes.begin();
    }
  });
  begin.back() = codes.size();
  return begin;
}
} // namespace fresco::poisson
