// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/solver/expected_values.h"
#include "poisson/solver/hat_function.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <fresco/core/parallel.h>
namespace fresco::poisson {
namespace {
/// Sums over samples, lengths in cells of the depth from the brick's corner.
struct Sums {
  float area = 0, moment = 0; ///< moment: of n . p
  Eigen::Vector3f normal = Eigen::Vector3f::Zero(), position = Eigen::Vector3f::Zero();
};

/// How far normals cancel: 0 where their mean has the length `limit` or more, 1 where it has 1/2 less.
float opposedOf(const Sums& sums, float limit)
{
  return sums.area > 0.f ? std::clamp(2.f * (limit - sums.normal.norm() / sums.area), 0.f, 1.f) : 0.f;
}

constexpr float sides_limit = 0.6f; // more are edges, 0.7

/// Of things and of edges, in part.
float sharpness(const Sums& sums) { return opposedOf(sums, 1.f); }

/// Half the distance between two sides, in cells; below 0 in a gap.
float halfThickness(const Sums& sums) { return (sums.moment - sums.normal.dot(sums.position / sums.area)) / sums.area; }

float expectedValue(const Sums& sums)
{
  constexpr float certain = 0.02f; // cells between the means of the sides: less may be noise
  if (!(sums.area > 0.f))
    return 0.f;
  const float m = halfThickness(sums), around = std::max(0.f, 1.f - 2.f * std::abs(m));
  return 0.5f * opposedOf(sums, sides_limit) * around * around * m / (std::abs(m) + certain);
}

/// At the finest depth, on both sides of what is thinner than a cell; the sums are of cells of twice that size.
float thickening(const Sums& sums)
{
  constexpr float half_rise = 0.15f; // of chi in half a cell
  const float thickness = sums.area > 0.f ? 4.f * halfThickness(sums) : 1.f;
  return thickness > 0.f ? -half_rise * opposedOf(sums, sides_limit) * std::max(0.f, 1.f - thickness) : 0.f;
}

/// The cells around the nodes of a brick.
class CellsAround {
public:
  CellsAround(const BrickLevel& level, const SampleLevel& cells, int finest, int threads)
      : level_(level), ranges_(sampleRanges(level, cells.codes, cells.depth, threads)), cells_(cells),
        scale_(std::ldexp(1.f, level.depth - finest))
  {}

  /// Cells -1..4 of a brick on each axis.
  struct Window {
    std::array<Sums, (brick_cells + 2) * (brick_cells + 2) * (brick_cells + 2)> cells;
    Sums& at(int x, int y, int z) { return cells[x + 1 + (brick_cells + 2) * (y + 1 + (brick_cells + 2) * (z + 1))]; }
  };

  /// False: on all nodes of the brick normals agree.
  bool load(Index brick, Window& window) const
  {
    const Neighbors neighbors = level_.neighborsOf(brick);
    const Eigen::Vector3f origin = level_.origin(brick);
    for (int o = 0; o < 27; ++o)
      if (neighbors[o] >= 0)
        for (const std::uint32_t i : ranges_[neighbors[o]])
          add(i, o, origin, window);
    return !isOneSided(window);
  }

  /// Values of the cells around each node, by nodeIndex().
  static void valuesOf(Window& window, float (*valueOf)(const Sums&), float* nodes)
  {
    for (int z = 0; z < brick_nodes; ++z)
      for (int y = 0; y < brick_nodes; ++y)
        for (int x = 0; x < brick_nodes; ++x)
          nodes[nodeIndex(x, y, z)] = valueOf(around(x, y, z, window));
  }

private:
  /// Whether no normals around any node cancel by half: those of all cells are within 60 degrees of one direction.
  static bool isOneSided(const Window& window)
  {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (const Sums& cell : window.cells)
      sum += cell.normal;
    const Eigen::Vector3f direction = sum.normalized();
    return std::all_of(window.cells.begin(), window.cells.end(),
                       [&](const Sums& cell) { return 2.f * cell.normal.dot(direction) >= cell.area; });
  }

  static Sums around(int x, int y, int z, Window& window)
  {
    Sums sum;
    for (int k = 0; k < 8; ++k) {
      const Sums& cell = window.at(x - (k & 1), y - (k >> 1 & 1), z - (k >> 2));
      sum.area += cell.area;
      sum.moment += cell.moment;
      sum.normal += cell.normal;
      sum.position += cell.position;
    }
    return sum;
  }

  /// @param offset offsetIndex() of the brick that cell i lies in
  void add(std::uint32_t i, int offset, const Eigen::Vector3f& origin, Window& window) const
  {
    const int offsets[3] = {offset % 3 - 1, offset / 3 % 3 - 1, offset / 9 - 1};
    int place[3];
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint64_t bits = cells_.codes[i] >> axis;
      place[axis] = int(bits & 1) + 2 * int(bits >> 3 & 1) + brick_cells * offsets[axis];
      if (place[axis] < -1 || place[axis] > brick_cells)
        return;
    }
    const CoarseSample& s = cells_.samples[i];
    const Eigen::Vector4f& flux = cells_.fluxes[i];
    const Eigen::Vector3f position = s.position * scale_ - origin, normal = flux.head<3>();
    const float area = s.area * scale_ * scale_;
    window.at(place[0], place[1], place[2]) = {area, area * (flux[3] * scale_ + normal.dot(position)), area * normal,
                                               area * position};
  }

  const BrickLevel& level_;
  SampleRanges ranges_;
  const SampleLevel& cells_;
  float scale_; ///< cells of the level per finest cell
};

/// What is asked of the cells around each sample.
struct Quantity {
  float (*of)(const Sums&);
  Array<float> values; ///< by sample; 0 where no normals cancel
};

void findAtSamples(const BrickLevel& level, const SampleLevel& cells, const SampleLevel& samples, int finest,
                   std::vector<Quantity>& wanted, int threads)
{
  for (Quantity& quantity : wanted)
    quantity.values.assign(samples.samples.size(), 0.f);
  const CellsAround cells_around(level, cells, finest, threads);
  const SampleRanges ranges = sampleRanges(level, samples.codes, samples.depth, threads);
  const float scale = std::ldexp(1.f, level.depth - finest);
  parallelFor(level.size(), threads, [&](Index b) {
    CellsAround::Window window;
    if (ranges[b].empty() || !cells_around.load(b, window))
      return;
    const Eigen::Vector3f origin = level.origin(b);
    for (Quantity& quantity : wanted) {
      float nodes[nodes_per_brick];
      CellsAround::valuesOf(window, quantity.of, nodes);
      for (const std::uint32_t i : ranges[b])
        quantity.values[i] = HatWeights::inBrick(samples.samples[i].position * scale - origin).interpolate(nodes);
    }
  });
}
} // namespace

Array<float> expectedValues(const BrickLevel& level, const SampleLevel& cells, const SampleLevel& samples, int finest,
                            int threads)
{
  if (cells.fluxes.empty())
    return {};
  std::vector<Quantity> wanted{{expectedValue, {}}};
  findAtSamples(level, cells, samples, finest, wanted, threads);
  return std::move(wanted[0].values);
}

void holdThin(const Octree& tree, const SampleGhosts& ghosts, const Array<Eigen::Vector3f>& normals,
              SampleLevel& finest, int threads)
{
  const SampleLevel cells = coarsen(finest, tree, threads, &normals);
  std::vector<Quantity> wanted{{thickening, {}}, {sharpness, {}}};
  findAtSamples(tree.levels[cells.depth], cells, finest, finest.depth, wanted, threads);
  for (Quantity& quantity : wanted)
    ghosts.renew(finest.codes, quantity.values);
  finest.expected = std::move(wanted[0].values);
  const Array<float>& sharp = wanted[1].values;
  parallelFor(sharp.size(), threads, [&](Index i) { finest.samples[i].noise *= 1.f - sharp[i]; });
}
} // namespace fresco::poisson
