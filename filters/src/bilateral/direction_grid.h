// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <cstdint>
#include <fresco/core/types.h>
#include <unordered_map>
#include <vector>
namespace fresco::filters {
constexpr float same_direction = 0.97f; ///< cosine between directions that are one

/// Which normals are frequent around a place, and how noisy the beams are there. Cells of a grid, each with what lies
/// in it and in the 26 around it.
class DirectionGrid {
public:
  /// @param edge of a cell, length, > 0
  explicit DirectionGrid(float edge) : edge_(edge) {}

  struct Sample {
    Eigen::Vector3f point, normal;
    float weight; ///< > 0
    float noise;  ///< deviation along the beam, length, where it could be measured, else 0
  };
  void add(const Sample& sample);

  struct Surroundings {
    std::vector<Eigen::Vector3f> directions; ///< unit, the most frequent first, then their opposites
    std::vector<float> shares;               ///< weight of each direction / weight of all samples around, 0..1
    float noise = 0;                         ///< length; 0 = unknown
  };
  /// Once all samples are there. Cells are independent of the number of threads.
  void finish(int threads);
  /// @param point one that was added
  const Surroundings& at(const Eigen::Vector3f& point) const;

private:
  struct Direction {
    Eigen::Vector3f sum;
    float weight;
  };
  struct Cell {
    std::array<std::int32_t, 3> place;
    std::vector<Direction> directions;
    double noise = 0;
    Index measured = 0;
    Surroundings around;
  };
  static void join(std::vector<Direction>& directions, const Direction& added, float same);
  std::uint64_t key(const std::array<std::int32_t, 3>& place) const;
  std::array<std::int32_t, 3> placeOf(const Eigen::Vector3f& point) const;
  Surroundings surroundingsOf(const Cell& cell) const;

  float edge_;
  std::unordered_map<std::uint64_t, std::size_t> numbers_;
  std::vector<Cell> cells_; ///< in the order of their first points
};
} // namespace fresco::filters
