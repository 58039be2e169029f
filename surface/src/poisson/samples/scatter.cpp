// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/samples/scatter.h"
#include "poisson/octree/bytes.h"
#include "poisson/octree/select.h"
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <fresco/core/parallel.h>
namespace fresco::poisson {
namespace {
using Places = std::vector<std::uint32_t>; // in the arrays of samples

/// The quantity of the header.
float scatterOf(const Array<Sample>& samples, Places::const_iterator begin, Places::const_iterator end)
{
  const double n = end - begin;
  Eigen::Vector3d position = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
  Eigen::Matrix3d directions = Eigen::Matrix3d::Zero();
  for (auto i = begin; i != end; ++i) {
    const Eigen::Vector3d direction = samples[*i].normal.cast<double>();
    position += samples[*i].position.cast<double>() / n;
    normal += direction / n;
    directions += direction * direction.transpose() / n;
  }
  double extent = 0, mean = 0, square = 0;
  for (auto i = begin; i != end; ++i) {
    const Eigen::Vector3d apart = samples[*i].position.cast<double>() - position;
    const double height = samples[*i].normal.cast<double>().dot(apart);
    extent += apart.squaredNorm() / n;
    mean += height / n;
    square += height * height / n;
  }
  if (!(extent > 0))
    return 0;
  const double variance = std::max(0.0, square - mean * mean) * n / (n - 1);
  const double largest = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>()
                             .computeDirect(directions, Eigen::EigenvaluesOnly)
                             .eigenvalues()[2];
  return std::min(1.0, 3 * variance / extent) * 1.5 * (1 - largest) * (1 - normal.norm());
}

/// Share of its area that a sample keeps.
float keptShare(float scatter)
{
  constexpr float surface = 0.3f, space = 0.5f; // of real scans 0 to 5 % are above, of scattered samples 85 and 75 %
  constexpr float least = 1e-3f;                // the mean of a cell's samples needs a weight
  return std::clamp((space - scatter) / (space - surface), least, 1.f);
}

/// Samples begin..end - 1 lie in one cell of a depth. From the finest cells upwards, those that no finer cell has enough
/// of are a group as soon as there are enough. @param left receives those without a group
void weighCell(const Array<std::uint64_t>& codes, Array<Sample>& samples, int finer_depths, Index begin, Index end,
               Places& left)
{
  constexpr std::size_t enough = 16;
  const std::size_t first = left.size();
  if (finer_depths == 0 || end - begin < Index(enough))
    for (; begin < end; ++begin)
      left.push_back(begin);
  while (begin < end) {
    const int shift = 3 * (finer_depths - 1);
    const std::uint64_t child = codes[begin] >> shift;
    const auto child_end = std::partition_point(codes.begin() + begin, codes.begin() + end,
                                                [&](std::uint64_t code) { return code >> shift == child; });
    weighCell(codes, samples, finer_depths - 1, begin, child_end - codes.begin(), left);
    begin = child_end - codes.begin();
  }
  if (left.size() - first < enough)
    return;
  const float kept = keptShare(scatterOf(samples, left.begin() + first, left.end()));
  for (auto i = left.begin() + first; i != left.end(); ++i)
    samples[*i].area *= kept;
  left.resize(first);
}
} // namespace

void weighScattered(const Octree& tree, Samples& samples, int threads)
{
  const int top = std::min(tree.partition ? tree.partition->atomDepth() : 5, tree.depth); // any gives the same groups
  const auto cellOf = [&](Index i) { return samples.codes[i] >> 3 * (tree.depth - top); };
  const Array<std::uint32_t> cells = runBegins(samples.codes.size(), threads, cellOf);
  std::vector<Places> left(cells.size() - 1);
  parallelFor(
      left.size(), threads,
      [&](Index c) { weighCell(samples.codes, samples.samples, tree.depth - top, cells[c], cells[c + 1], left[c]); },
      1);
  Places own;
  Array<std::uint64_t> codes;
  Array<Sample> rest;
  for (const Places& of_cell : left)
    for (const std::uint32_t i : of_cell) {
      own.push_back(i);
      codes.push_back(samples.codes[i]);
      rest.push_back(samples.samples[i]);
    }
  Exchange& exchange = tree.exchange();
  const Index before = exchange.sumBefore(own.size());
  codes = gatherAll(exchange, codes.data(), codes.size());
  rest = gatherAll(exchange, rest.data(), rest.size());
  Places lone;
  weighCell(codes, rest, tree.depth, 0, codes.size(), lone);
  for (std::size_t i = 0; i < own.size(); ++i)
    samples.samples[own[i]].area = rest[before + i].area;
}
} // namespace fresco::poisson
