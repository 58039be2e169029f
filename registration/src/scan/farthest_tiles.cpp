// SPDX-License-Identifier: BSD-3-Clause
#include "scan/farthest_tiles.h"
#include <fresco/core/constants.h>
namespace fresco::registration {
namespace {
// The direction of a place on a face, -1..1 across either way; within 0.002 of what cubeCell() takes for it.
Eigen::Vector3f directionAt(Index face, float u, float v)
{
  constexpr float quarter = static_cast<float>(pi) / 4.f;
  const Index axis = face / 2;
  Eigen::Vector3f direction;
  direction[axis] = face % 2 == 0 ? 1.f : -1.f;
  direction[(axis + 1) % 3] = std::tan(quarter * u);
  direction[(axis + 2) % 3] = std::tan(quarter * v);
  return direction.normalized();
}

// The middles of all tiles, and the largest angle between one and a direction of its tile, radians.
struct Tiles {
  explicit Tiles(int side)
  {
    constexpr float slack = 0.005f; // radians: more than directionAt() is off by
    const auto across = [&](float slot) { return 2.f * slot / side - 1.f; };
    float least_cosine = 1.f;
    for (Index tile = 0; tile < 6 * side * side; ++tile) {
      const Index face = tile / (side * side), row = tile / side % side, column = tile % side;
      middles.push_back(directionAt(face, across(row + 0.5f), across(column + 0.5f)));
      for (const Index i : {0, 1})
        for (const Index k : {0, 1})
          least_cosine =
              std::min(least_cosine, middles.back().dot(directionAt(face, across(row + i), across(column + k))));
    }
    radius = std::acos(least_cosine) + slack;
  }
  std::vector<Eigen::Vector3f> middles; // unit
  float radius;
};

// Of a tile the largest of its cells, also of those that reach into it.
std::vector<float> largestOfTiles(const std::vector<float>& farthest, int side, int tile_side)
{
  std::vector<float> largest(6 * tile_side * tile_side, 0.f);
  const auto first = [&](Index slot) { return slot * tile_side / side; };
  const auto last = [&](Index slot) { return ((slot + 1) * tile_side - 1) / side; };
  for (std::size_t cell = 0; cell < farthest.size(); ++cell) {
    const Index face = cell / (side * side), row = cell / side % side, column = cell % side;
    for (Index i = first(row); i <= last(row); ++i)
      for (Index k = first(column); k <= last(column); ++k) {
        float& tile = largest[(face * tile_side + i) * tile_side + k];
        tile = std::max(tile, farthest[cell]);
      }
  }
  return largest;
}
} // namespace

FarthestTiles::FarthestTiles(const std::vector<float>& farthest, int side)
{
  constexpr int most = 16; // tiles along an edge, 6 degrees each: finer ones cost more than they tell
  side_ = std::min(side, most);
  const Tiles tiles(side_);
  const std::vector<float> largest = largestOfTiles(farthest, side, side_);
  const float least_cosine = std::cos(widest + 2.f * tiles.radius);
  farthest_ = largest;
  for (std::size_t i = 0; i < largest.size(); ++i)
    for (std::size_t k = 0; k < largest.size(); ++k)
      if (largest[k] > farthest_[i] && tiles.middles[i].dot(tiles.middles[k]) >= least_cosine)
        farthest_[i] = largest[k];
}
} // namespace fresco::registration
