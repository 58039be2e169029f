// SPDX-License-Identifier: BSD-3-Clause
#include "volumetric_samples.h"
#include "volumetric_cube.h"
#include "volumetric_morton.h"
#include "volumetric_sort.h"
#include <cmath>
#include <fresco/common/parallel.h>
#include <fresco/common/require.h>
namespace fresco::volumetric {
namespace {
std::uint64_t cellCode(const Eigen::Vector3f& cell, int depth)
{
  const float last = static_cast<float>((1 << depth) - 1);
  const Eigen::Vector3f c = cell.cwiseMax(0.f).cwiseMin(last);
  return mortonCode(static_cast<std::uint32_t>(c.x()), static_cast<std::uint32_t>(c.y()),
                    static_cast<std::uint32_t>(c.z()));
}

Eigen::Vector3f toCells(const PointSet& set, Index i, const Cube& cube)
{
  return ((set.points.col(i).cast<double>() - cube.corner) / cube.cell()).cast<float>();
}

std::vector<KeyIndex> sortedCells(const PointSet& set, const std::vector<Index>& usable, const Cube& cube, int threads)
{
  std::vector<KeyIndex> keys(usable.size());
  parallelFor(static_cast<Index>(usable.size()), threads, [&](Index k) {
    const Index i = usable[static_cast<std::size_t>(k)];
    keys[static_cast<std::size_t>(k)] = {cellCode(toCells(set, i, cube), cube.depth), static_cast<std::uint32_t>(i)};
  });
  sortByKey(keys, 3 * cube.depth, threads);
  return keys;
}

/// Where each cell's run of points begins, and the end.
std::vector<std::uint32_t> cellRuns(const std::vector<KeyIndex>& keys)
{
  std::vector<std::uint32_t> runs;
  runs.reserve(keys.size() / 2 + 2);
  for (std::size_t k = 0; k < keys.size(); ++k)
    if (k == 0 || keys[k].key != keys[k - 1].key)
      runs.push_back(static_cast<std::uint32_t>(k));
  runs.push_back(static_cast<std::uint32_t>(keys.size()));
  return runs;
}

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

Sums sumCell(const PointSet& set, const Weights& weights, const KeyIndex* begin, const KeyIndex* end)
{
  Sums sums;
  for (const KeyIndex* k = begin; k < end; ++k) {
    const Index i = k->index;
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
  const Usable usable = usablePoints(set, options);
  result.cube = usable.cube;
  result.used_points = static_cast<Index>(usable.points.size());
  result.left_out_points = set.size() - result.used_points;
  const std::vector<KeyIndex> keys = sortedCells(set, usable.points, result.cube, options.threads);
  const std::vector<std::uint32_t> runs = cellRuns(keys);
  const std::size_t n = runs.size() - 1;
  result.codes.resize(n);
  result.samples.resize(n);
  if (set.colors.cols() > 0 || set.intensities.size() > 0)
    result.attributes.resize(n);
  parallelFor(static_cast<Index>(n), options.threads, [&](Index c) {
    const auto i = static_cast<std::size_t>(c);
    const Sums sums = sumCell(set, usable.weights, &keys[runs[i]], keys.data() + runs[i + 1]);
    result.codes[i] = keys[runs[i]].key;
    Sample& sample = result.samples[i];
    sample.position = ((sums.position / sums.weight - result.cube.corner) / result.cube.cell()).cast<float>();
    const double length = sums.normal.norm();
    sample.normal = (sums.normal / std::max(length, 1e-12)).cast<float>();
    sample.area = static_cast<float>(sums.weight);
    if (!result.attributes.empty())
      result.attributes[i] = (sums.attributes / sums.weight).cast<float>();
  });
  return result;
}

SampleLevel finestLevel(const Samples& samples)
{
  SampleLevel level;
  level.depth = samples.cube.depth;
  level.codes = samples.codes;
  level.samples.reserve(samples.samples.size());
  for (const Sample& s : samples.samples)
    level.samples.push_back({s.position, s.area, s.noise, s.depth});
  return level;
}

SampleLevel coarsen(const SampleLevel& fine)
{
  SampleLevel coarse;
  coarse.depth = fine.depth - 1;
  for (std::size_t i = 0; i < fine.codes.size();) {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    double area = 0, variance = 0, depth = 0;
    const std::uint64_t code = fine.codes[i] >> 3;
    for (; i < fine.codes.size() && fine.codes[i] >> 3 == code; ++i) {
      position += fine.samples[i].area * fine.samples[i].position.cast<double>();
      area += fine.samples[i].area;
      depth += static_cast<double>(fine.samples[i].area * fine.samples[i].depth);
      variance += std::pow(static_cast<double>(fine.samples[i].area * fine.samples[i].noise), 2);
    }
    coarse.codes.push_back(code);
    coarse.samples.push_back({(position / area).cast<float>(), static_cast<float>(area),
                              static_cast<float>(std::sqrt(variance) / area), static_cast<float>(depth / area)});
  }
  return coarse;
}

std::vector<std::uint32_t> sampleRanges(const BrickLevel& level, const std::vector<std::uint64_t>& codes, int depth)
{
  const int shift = 3 * (depth - level.depth + 2);
  std::vector<std::uint32_t> begin(level.codes.size() + 1);
  std::size_t at = 0;
  for (std::size_t b = 0; b < level.codes.size(); ++b) {
    while (at < codes.size() && codes[at] >> shift < level.codes[b])
      ++at;
    begin[b] = static_cast<std::uint32_t>(at);
  }
  begin.back() = static_cast<std::uint32_t>(codes.size());
  return begin;
}
} // namespace fresco::volumetric
