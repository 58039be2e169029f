// SPDX-License-Identifier: BSD-3-Clause
#include "bilateral/direction_grid.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
namespace fresco::filters {
std::array<std::int32_t, 3> DirectionGrid::placeOf(const Eigen::Vector3f& point) const
{
  std::array<std::int32_t, 3> place;
  for (int axis = 0; axis < 3; ++axis)
    place[axis] = std::clamp(std::floor(point[axis] / edge_), -1048570.f, 1048570.f);
  return place;
}

std::uint64_t DirectionGrid::key(const std::array<std::int32_t, 3>& place) const
{
  std::uint64_t key = 0;
  for (const std::int32_t coordinate : place)
    key = key << 21 | std::uint64_t(coordinate + (1 << 20));
  return key;
}

void DirectionGrid::join(std::vector<Direction>& directions, const Direction& added, float same)
{
  const float least = same * added.sum.norm();
  for (Direction& direction : directions)
    if (direction.sum.dot(added.sum) > least * direction.sum.norm()) {
      direction.sum += added.sum;
      direction.weight += added.weight;
      return;
    }
  directions.push_back(added);
}

void DirectionGrid::add(const Sample& sample)
{
  constexpr float one_direction = 0.985f; // cosine between normals of one direction, within a cell
  const auto place = placeOf(sample.point);
  const auto [found, is_new] = numbers_.try_emplace(key(place), cells_.size());
  if (is_new)
    cells_.push_back({place, {}, 0, 0, {}});
  Cell& cell = cells_[found->second];
  join(cell.directions, {sample.weight * sample.normal, sample.weight}, one_direction);
  cell.noise += sample.noise;
  cell.measured += sample.noise > 0;
}

DirectionGrid::Surroundings DirectionGrid::surroundingsOf(const Cell& cell) const
{
  constexpr float least_share = 0.05f; // of the weight: of round things no direction has more
  constexpr Index enough = 10;         // points that tell the noise
  std::vector<Direction> all;
  double noise = 0;
  Index measured = 0;
  for (int k = 0; k < 27; ++k) {
    const auto found =
        numbers_.find(key({cell.place[0] + k % 3 - 1, cell.place[1] + k / 3 % 3 - 1, cell.place[2] + k / 9 - 1}));
    if (found == numbers_.end())
      continue;
    const Cell& other = cells_[found->second];
    all.insert(all.end(), other.directions.begin(), other.directions.end());
    noise += other.noise;
    measured += other.measured;
  }
  float total = 0;
  for (const Direction& direction : all)
    total += direction.weight;
  const auto heavier = [](const Direction& a, const Direction& b) { return a.weight > b.weight; };
  std::stable_sort(all.begin(), all.end(), heavier);
  std::vector<Direction> joined;
  for (const Direction& direction : all)
    join(joined, direction, same_direction);
  Surroundings around;
  for (const Direction& direction : joined)
    if (direction.weight > least_share * total) {
      around.directions.push_back(direction.sum.normalized());
      around.shares.push_back(direction.weight / total);
    }
  const std::size_t seen = around.directions.size();
  for (std::size_t k = 0; k < seen; ++k) {
    around.directions.emplace_back(-around.directions[k]);
    around.shares.push_back(around.shares[k]);
  }
  around.noise = measured >= enough ? noise / measured : 0.0;
  return around;
}

void DirectionGrid::finish(int threads)
{
  double sum = 0;
  Index measured = 0;
  for (const Cell& cell : cells_) {
    sum += cell.noise;
    measured += cell.measured;
  }
  const float noise = measured > 0 ? sum / measured : 0.0; // mean of what was measured anywhere
  parallelFor(cells_.size(), threads, [&](Index c) {
    Cell& cell = cells_[c];
    cell.around = surroundingsOf(cell);
    if (!(cell.around.noise > 0))
      cell.around.noise = noise;
  });
}

const DirectionGrid::Surroundings& DirectionGrid::at(const Eigen::Vector3f& point) const
{
  return cells_[numbers_.at(key(placeOf(point)))].around;
}
} // namespace fresco::filters
