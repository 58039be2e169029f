// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/samples/samples.h"
#include "poisson/octree/select.h"
#include "poisson/samples/cell_sums.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
namespace fresco::poisson {
Samples gatherSamples(const PointSet& set, const VolumetricOptions& options)
{
  return gatherSamples(WholeSet(set), options);
}

Samples gatherSamples(const PointStream& points, const VolumetricOptions& options)
{
  const Extent extent = findExtent(points, options);
  if (isOnePiece(extent)) {
    Samples samples;
    forEachPiece(points, extent, options.threads,
                 [&](const SortedPoints& piece) { samples = samplesOf(piece, extent, options.threads); });
    return samples;
  }
  CellSums sums(findCells(points, extent, options.threads), extent, options.threads);
  forEachPiece(points, extent, options.threads, [&](const SortedPoints& piece) { sums.add(piece, options.threads); });
  return sums.takeSamples(options.threads);
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

Array<Eigen::Vector3f> normalsOf(const Samples& samples, int threads)
{
  Array<Eigen::Vector3f> normals(samples.samples.size());
  parallelFor(normals.size(), threads, [&](Index i) { normals[i] = samples.samples[i].normal; });
  return normals;
}

namespace {
/// SampleLevel::fluxes of a sample in which those of a run are joined.
Eigen::Vector4f joinedFlux(const SampleLevel& fine, SampleRun run, const CoarseSample& joined,
                           const Array<Eigen::Vector3f>* normals)
{
  Eigen::Vector4f sum = Eigen::Vector4f::Zero();
  for (const std::uint32_t i : run) {
    const CoarseSample& s = fine.samples[i];
    Eigen::Vector4f flux =
        normals ? Eigen::Vector4f((*normals)[i].homogeneous() - Eigen::Vector4f::UnitW()) : fine.fluxes[i];
    flux[3] += flux.head<3>().dot(s.position - joined.position);
    sum += s.area * flux;
  }
  return sum / joined.area;
}
} // namespace

SampleLevel coarsen(const SampleLevel& fine, int threads, const Array<Eigen::Vector3f>* normals)
{
  const bool has_fluxes = normals || !fine.fluxes.empty();
  const auto parentOf = [&](Index i) { return fine.codes[i] >> 3; };
  const Array<std::uint32_t> runs = runBegins(fine.codes.size(), threads, parentOf);
  SampleLevel coarse;
  coarse.depth = fine.depth - 1;
  coarse.codes.resize(runs.size() - 1);
  coarse.samples.resize(runs.size() - 1);
  coarse.fluxes.resize(has_fluxes ? runs.size() - 1 : 0);
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
    if (has_fluxes)
      coarse.fluxes[c] = joinedFlux(fine, {runs[c], runs[c + 1]}, joined, normals);
  });
  return coarse;
}

SampleRanges sampleRanges(const BrickLevel& level, const Array<std::uint64_t>& codes, int depth, int threads)
{
  const int shift = 3 * (depth - level.depth + 2);
  SampleRanges ranges;
  ranges.begin.resize(level.codes.size() + 1);
  if (level.ghosts.isDivided())
    ranges.end.resize(level.codes.size());
  parallelRanges(level.size(), threads, [&](Index first, Index last) {
    const auto isBefore = [&](std::uint64_t code, std::uint64_t brick) { return code >> shift < brick; };
    auto at = std::lower_bound(codes.begin(), codes.end(), level.codes[first], isBefore);
    for (Index b = first; b < last; ++b) {
      while (at != codes.end() && isBefore(*at, level.codes[b]))
        ++at;
      ranges.begin[b] = at - codes.begin();
      if (ranges.end.empty())
        continue;
      while (at != codes.end() && isBefore(*at, level.codes[b] + 1))
        ++at;
      ranges.end[b] = at - codes.begin();
    }
  });
  ranges.begin.back() = codes.size();
  return ranges;
}
} // namespace fresco::poisson
