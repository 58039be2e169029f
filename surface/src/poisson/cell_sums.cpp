// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/cell_sums.h"
#include "poisson/octree/select.h"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fresco/core/morton.h>
#include <fresco/core/release.h>
namespace fresco::poisson {
namespace {
constexpr double unit = 1 << 28;    // see CellSums::Sums
constexpr double color_range = 256; // a power of two: means of equal colours are exact
constexpr int block_bits = 20;      // cells that are given back at a time: large enough for the system to take them

template <typename T>
std::vector<Array<T>> zeroBlocks(Index cells, int threads)
{
  std::vector<Array<T>> blocks;
  for (Index begin = 0; begin < cells; begin += Index(1) << block_bits) {
    blocks.emplace_back(std::min(cells - begin, Index(1) << block_bits));
    Array<T>& block = blocks.back();
    parallelRanges(block.size(), threads, [&](Index from, Index to) {
      std::memset(static_cast<void*>(block.data() + from), 0, (to - from) * sizeof(T));
    });
  }
  return blocks;
}

template <typename T>
T& at(std::vector<Array<T>>& blocks, std::uint32_t number)
{
  return blocks[number >> block_bits][number & ((1U << block_bits) - 1)];
}

std::int64_t whole(double value) { return std::llrint(value); }

Eigen::Vector3d cellOf(std::uint64_t code)
{
  const auto [x, y, z] = mortonCell(code);
  return {double(x), double(y), double(z)};
}
} // namespace

/// Points begin .. end - 1, which lie in one cell.
struct CellSums::CellPoints {
  const SortedPoints& points;
  Index begin, end;
};

CellSums::CellSums(OccupiedCells cells, const Extent& extent, int threads)
    : cells_(std::move(cells)), first_(cells_.firstCells()), extent_(extent),
      intensity_unit_(std::exp2(std::ceil(std::log2(std::max(extent.largest_intensity, 1e-30f))))),
      sums_(zeroBlocks<Sums>(first_.back(), threads))
{
  if (extent.colors || extent.intensities)
    attribute_sums_ = zeroBlocks<AttributeSums>(first_.back(), threads);
}

void CellSums::add(const SortedPoints& points, int threads)
{
  const Array<std::uint32_t> runs = runBegins(points.size(), threads, [&](Index k) { return points.code(k); });
  parallelRanges(Index(runs.size()) - 1, threads, [&](Index begin, Index end) {
    const auto before = [](const OccupiedBrick& brick, std::uint64_t code) { return brick.code < code; };
    const Array<OccupiedBrick>& bricks = cells_.bricks();
    auto brick = std::lower_bound(bricks.begin(), bricks.end(), points.code(runs[begin]) >> 6, before);
    for (Index r = begin; r < end; ++r) {
      const std::uint64_t code = points.code(runs[r]);
      while (brick->code != code >> 6)
        ++brick;
      const std::uint64_t cells_before = brick->cells & ((std::uint64_t(1) << (code & 63)) - 1);
      addCell({points, runs[r], runs[r + 1]}, first_[brick - bricks.begin()] + __builtin_popcountll(cells_before));
    }
  });
}

void CellSums::addCell(const CellPoints& cell, std::uint32_t number)
{
  Sums sums = at(sums_, number);
  const PointSet& set = cell.points.set();
  const Eigen::Vector3d corner = cellOf(cell.points.code(cell.begin));
  for (Index k = cell.begin; k < cell.end; ++k) {
    const Index i = cell.points.point(k);
    const Whole weight = std::max<Whole>(whole(unit * extent_.weights.of(set, i)), 1);
    const Eigen::Vector3d within = toCells(set, i, extent_) - corner;
    const Eigen::Vector3d normal = set.normals.col(i).cast<double>().normalized();
    sums.weight += weight;
    for (int axis = 0; axis < 3; ++axis) {
      sums.position[axis] += whole(weight * within[axis]);
      sums.normal[axis] += whole(weight * normal[axis]);
    }
    if (!attribute_sums_.empty())
      addAttributes(set, i, weight, at(attribute_sums_, number));
  }
  at(sums_, number) = sums;
}

void CellSums::addAttributes(const PointSet& set, Index i, Whole weight, AttributeSums& sums) const
{
  for (int channel = 0; channel < 3 && extent_.colors; ++channel)
    sums.color[channel] += whole(weight * (set.colors(channel, i) / color_range));
  if (extent_.intensities && std::isfinite(set.intensities[i]))
    sums.intensity += whole(weight * (set.intensities[i] / intensity_unit_));
}

Sample CellSums::sampleOf(std::uint64_t code, const Sums& sums) const
{
  Sample sample;
  const Eigen::Vector3d corner = cellOf(code);
  Eigen::Vector3d normal;
  for (int axis = 0; axis < 3; ++axis) {
    const float lower = corner[axis], upper = std::nextafter(lower + 1.f, 0.f);
    const double position = corner[axis] + double(sums.position[axis]) / double(sums.weight);
    sample.position[axis] = std::clamp(static_cast<float>(position), lower, upper);
    normal[axis] = double(sums.normal[axis]) / unit;
  }
  sample.normal = (normal / std::max(normal.norm(), 1e-12)).cast<float>();
  sample.area = double(sums.weight) / unit;
  sample.depth = sample.noise = 0.f;
  return sample;
}

Attributes CellSums::attributesOf(const AttributeSums& sums, Whole weight) const
{
  Attributes attributes;
  for (int channel = 0; channel < 3; ++channel)
    attributes[channel] = double(sums.color[channel]) / double(weight) * color_range;
  attributes[3] = double(sums.intensity) / double(weight) * intensity_unit_;
  return attributes;
}

Samples CellSums::takeSamples(int threads)
{
  Samples result;
  result.cube = extent_.cube;
  result.used_points = extent_.usable;
  result.left_out_points = extent_.all - extent_.usable;
  result.origin = extent_.origin;
  result.has_colors = extent_.colors;
  result.has_intensities = extent_.intensities;
  result.codes = cells_.codes(threads);
  cells_ = OccupiedCells();
  result.samples.resize(result.codes.size());
  result.attributes.resize(attribute_sums_.empty() ? 0 : result.codes.size());
  for (std::size_t b = 0; b < sums_.size(); ++b) {
    const std::size_t begin = b << block_bits;
    parallelFor(sums_[b].size(), threads, [&](Index i) {
      result.samples[begin + i] = sampleOf(result.codes[begin + i], sums_[b][i]);
      if (!attribute_sums_.empty())
        result.attributes[begin + i] = attributesOf(attribute_sums_[b][i], sums_[b][i].weight);
    });
    releaseMemory(sums_[b]);
    if (!attribute_sums_.empty())
      releaseMemory(attribute_sums_[b]);
  }
  return result;
}
} // namespace fresco::poisson
