// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/samples/cell_sums.h"
#include "poisson/octree/select.h"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fresco/core/machine_memory.h>
#include <fresco/core/morton.h>
namespace fresco::poisson {
namespace {
using Whole = CellSum::Whole;
constexpr double unit = 1 << 28;    // see CellSum
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

Whole whole(double value) { return std::llrint(value); }

Eigen::Vector3d cellOf(std::uint64_t code)
{
  const auto [x, y, z] = mortonCell(code);
  return {double(x), double(y), double(z)};
}

/// Cells of a brick that hold points and come before one of its cells.
int cellsBefore(const OccupiedBrick& brick, std::uint64_t code)
{
  return __builtin_popcountll(brick.cells & ((std::uint64_t(1) << (code & 63)) - 1));
}

} // namespace

Array<std::uint32_t> cellBegins(const SortedPoints& points, int threads)
{
  return runBegins(points.size(), threads, [&](Index k) { return points.code(k); });
}

PointSums::PointSums(const Extent& extent)
    : extent_(extent), intensity_unit_(std::exp2(std::ceil(std::log2(std::max(extent.largest_intensity, 1e-30f)))))
{}

Whole PointSums::weightOf(const PointSet& set, Index i) const
{
  return std::max<Whole>(whole(unit * extent_.weights.of(set, i)), 1);
}

void PointSums::add(const SortedPoints& points, Index begin, Index end, CellSum& sum) const
{
  const PointSet& set = points.set();
  const Eigen::Vector3d corner = cellOf(points.code(begin));
  for (Index k = begin; k < end; ++k) {
    const Index i = points.point(k);
    const Whole weight = weightOf(set, i);
    const Eigen::Vector3d within = toCells(set, i, extent_) - corner;
    const Eigen::Vector3d normal = set.normals.col(i).cast<double>().normalized();
    sum.weight += weight;
    for (int axis = 0; axis < 3; ++axis) {
      sum.position[axis] += whole(weight * within[axis]);
      sum.normal[axis] += whole(weight * normal[axis]);
    }
  }
}

void PointSums::addAttributes(const SortedPoints& points, Index begin, Index end, AttributeSum& sum) const
{
  const PointSet& set = points.set();
  for (Index k = begin; k < end; ++k) {
    const Index i = points.point(k);
    const Whole weight = weightOf(set, i);
    for (int channel = 0; channel < 3 && extent_.colors; ++channel)
      sum.color[channel] += whole(weight * (set.colors(channel, i) / color_range));
    if (extent_.intensities && std::isfinite(set.intensities[i]))
      sum.intensity += whole(weight * (set.intensities[i] / intensity_unit_));
  }
}

Sample PointSums::sampleOf(std::uint64_t code, const CellSum& sum) const
{
  constexpr float below_one = 1.f - 0x1p-24f; // times a whole number: the float below it
  Sample sample;
  const Eigen::Vector3d corner = cellOf(code);
  Eigen::Vector3d normal;
  for (int axis = 0; axis < 3; ++axis) {
    const float lower = corner[axis], upper = (lower + 1.f) * below_one;
    const double position = corner[axis] + double(sum.position[axis]) / double(sum.weight);
    sample.position[axis] = std::clamp(static_cast<float>(position), lower, upper);
    normal[axis] = double(sum.normal[axis]) / unit;
  }
  sample.normal = (normal / std::max(normal.norm(), 1e-12)).cast<float>();
  sample.area = double(sum.weight) / unit;
  sample.depth = sample.noise = 0.f;
  return sample;
}

Attributes PointSums::attributesOf(const AttributeSum& sum, Whole weight) const
{
  Attributes attributes;
  for (int channel = 0; channel < 3; ++channel)
    attributes[channel] = double(sum.color[channel]) / double(weight) * color_range;
  attributes[3] = double(sum.intensity) / double(weight) * intensity_unit_;
  return attributes;
}

Samples PointSums::emptySamples(Array<std::uint64_t> codes) const
{
  Samples samples;
  samples.cube = extent_.cube;
  samples.used_points = extent_.usable;
  samples.left_out_points = extent_.all - extent_.usable;
  samples.origin = extent_.origin;
  samples.has_colors = extent_.colors;
  samples.has_intensities = extent_.intensities;
  samples.samples.resize(codes.size());
  samples.attributes.resize(hasAttributes() ? codes.size() : 0);
  samples.codes = std::move(codes);
  return samples;
}

Samples samplesOf(const SortedPoints& points, const Extent& extent, int threads)
{
  const PointSums sums(extent);
  const Array<std::uint32_t> begins = cellBegins(points, threads);
  Samples result = sums.emptySamples(Array<std::uint64_t>(begins.size() - 1));
  parallelFor(result.codes.size(), threads, [&](Index c) {
    CellSum sum = {};
    sums.add(points, begins[c], begins[c + 1], sum);
    result.codes[c] = points.code(begins[c]);
    result.samples[c] = sums.sampleOf(result.codes[c], sum);
    if (!sums.hasAttributes())
      return;
    AttributeSum attributes = {};
    sums.addAttributes(points, begins[c], begins[c + 1], attributes);
    result.attributes[c] = sums.attributesOf(attributes, sum.weight);
  });
  return result;
}

CellSums::CellSums(OccupiedCells cells, const Extent& extent, int threads)
    : cells_(std::move(cells)), first_(cells_.firstCells()), points_(extent),
      sums_(zeroBlocks<CellSum>(first_.back(), threads))
{
  if (points_.hasAttributes())
    attribute_sums_ = zeroBlocks<AttributeSum>(first_.back(), threads);
}

void CellSums::add(const SortedPoints& points, int threads)
{
  const Array<std::uint32_t> begins = cellBegins(points, threads);
  const Array<OccupiedBrick>& bricks = cells_.bricks();
  parallelRanges(Index(begins.size()) - 1, threads, [&](Index first, Index last) {
    const auto before = [](const OccupiedBrick& brick, std::uint64_t code) { return brick.code < code; };
    auto brick = std::lower_bound(bricks.begin(), bricks.end(), points.code(begins[first]) >> 6, before);
    for (Index c = first; c < last; ++c) {
      const std::uint64_t code = points.code(begins[c]);
      while (brick->code != code >> 6)
        ++brick;
      const std::uint32_t number = first_[brick - bricks.begin()] + cellsBefore(*brick, code);
      points_.add(points, begins[c], begins[c + 1], at(sums_, number));
      if (points_.hasAttributes())
        points_.addAttributes(points, begins[c], begins[c + 1], at(attribute_sums_, number));
    }
  });
}

void CellSums::add(std::uint64_t code, const CellSum& sum, const AttributeSum& attributes)
{
  const auto before = [](const OccupiedBrick& brick, std::uint64_t c) { return brick.code < c; };
  const auto brick = std::lower_bound(cells_.bricks().begin(), cells_.bricks().end(), code >> 6, before);
  const std::uint32_t number = first_[brick - cells_.bricks().begin()] + cellsBefore(*brick, code);
  CellSum& to = at(sums_, number);
  to.weight += sum.weight;
  for (int axis = 0; axis < 3; ++axis) {
    to.position[axis] += sum.position[axis];
    to.normal[axis] += sum.normal[axis];
  }
  if (!points_.hasAttributes())
    return;
  AttributeSum& attributes_to = at(attribute_sums_, number);
  for (int channel = 0; channel < 3; ++channel)
    attributes_to.color[channel] += attributes.color[channel];
  attributes_to.intensity += attributes.intensity;
}

Samples CellSums::takeSamples(int threads)
{
  Samples result = points_.emptySamples(cells_.codes(threads));
  cells_ = OccupiedCells();
  for (std::size_t b = 0; b < sums_.size(); ++b) {
    const std::size_t begin = b << block_bits;
    parallelFor(sums_[b].size(), threads, [&](Index i) {
      result.samples[begin + i] = points_.sampleOf(result.codes[begin + i], sums_[b][i]);
      if (points_.hasAttributes())
        result.attributes[begin + i] = points_.attributesOf(attribute_sums_[b][i], sums_[b][i].weight);
    });
    releaseMemory(sums_[b]);
    if (points_.hasAttributes())
      releaseMemory(attribute_sums_[b]);
  }
  return result;
}
} // namespace fresco::poisson
