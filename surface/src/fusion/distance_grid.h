// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fusion/depth_frame.h"
#include "fusion/vote_kernels.h"
#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>
namespace fresco::fusion {
/// Of a node within its brick.
inline int nodeIndex(int x, int y, int z) { return x + brick_side * (y + brick_side * z); }

/// Of 8^3 nodes, x fastest. 4 kB.
struct Brick {
  std::array<float, brick_size> distance{}; ///< weighted mean, in the unit of the frames; in the end NaN without weight
  std::array<float, brick_size> weight{};
};

/// Signed distances to the surface seen by the frames, positive in front of it, at the nodes of a grid. Bricks are there
/// where a frame saw a surface.
class DistanceGrid {
public:
  DistanceGrid(double cell, double truncation);

  /// Makes bricks around the surface in a frame.
  void allocate(const DepthFrame& frame, int threads);

  /// One vote of a frame for each node that it sees. A vote far from what `reference` says counts less.
  /// @param reference the same grid before, or null: all votes count alike
  void integrate(const DepthFrame& frame, const DistanceGrid* reference, float free_weight, int threads);

  /// Brings the votes for whole bricks to their nodes; after the last frame.
  void finish(const DistanceGrid* reference, int threads);

  /// A grid of the same bricks without votes.
  DistanceGrid emptied() const;

  Index size() const { return bricks_.size(); }
  float cell() const { return cell_; }
  float truncation() const { return truncation_; }
  const Brick& brick(Index b) const { return bricks_[b]; }
  const Eigen::Vector3i& place(Index b) const { return places_[b]; } ///< in bricks

  /// From where the surface within the brick was seen best.
  const Eigen::Vector3f& viewpoint(Index b) const { return best_[b].viewpoint; }

  /// -1 where there is none.
  Index find(const Eigen::Vector3i& place) const;

  struct Distance {
    float value;
    Eigen::Vector3f gradient; ///< dimensionless
  };

  /// Trilinear; nothing where a node around `point` has no votes. After finish().
  /// @param near a brick to look into first, -1 = none; becomes that of `point`
  std::optional<Distance> at(const Eigen::Vector3f& point, Index& near) const;

private:
  struct BestView {
    Eigen::Vector3f viewpoint = Eigen::Vector3f::Zero();
    float votes = 0;
  };
  enum class Visibility { Hidden, Free, Surface };
  struct Seen {
    Visibility visibility;
    float depth; ///< of its centre
  };
  Seen see(const DepthFrame& frame, Index b) const;
  void integrateBrick(const DepthFrame& frame, Index b, const float* reference, float free_weight);
  bool makeBrick(const Eigen::Vector3i& place);

  float cell_, truncation_;
  std::unordered_map<std::uint64_t, Index> index_;
  std::vector<Brick> bricks_;
  std::vector<Eigen::Vector3i> places_;
  std::vector<float> free_; ///< weight of the frames that saw through the whole brick
  std::vector<BestView> best_;
  std::vector<std::array<Index, 8>> next_; ///< itself and those one on along the axes (bits 0..2); -1 = none
};
} // namespace fresco::fusion
