// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/node_field.h"
#include "poisson/samples/samples.h"
namespace fresco::poisson {
/// Local sampling density (Kazhdan, Bolitho & Hoppe 2006, section 4.5), kept as sample weights splatted onto the nodes
/// of each depth but the finest.
class Density {
public:
  Density(const Octree& tree, const Samples& samples, int threads);

  struct Estimate {
    float depth;   ///< octree depth at which a cell's face holds one sample
    float area;    ///< of the surface per unit of weight, in faces of a finest cell
    float support; ///< as `depth`, but no more than the samples nearby sustain: small where all lie to one side
  };

  /// Asks for many places, one brick's after the other: it keeps the weights around the last brick of each depth.
  class Reader {
  public:
    explicit Reader(const Density& density);

    /// @param depth, brick brick of the octree that the position lies in
    /// @param position     in cells of the finest depth
    Estimate at(int depth, Index brick, const Eigen::Vector3f& position);

  private:
    static constexpr int side = brick_nodes + 2; ///< nodes -1..5: all that a position in the brick is between
    struct Window {
      Index brick = -1;
      float weights[side * side * side];
    };
    void load(int depth, Index brick);
    float weightAt(int depth, Index brick, const Eigen::Vector3f& position);

    const Density& density_;
    std::vector<Window> windows_; ///< by depth
  };

private:
  const Octree* tree_;
  std::vector<NodeField> fields_; ///< by depth
};

/// Sets depth and area (until now the weight) of each sample.
/// @param samples_per_node see VolumetricOptions
void estimateDensity(const Octree& tree, const Density& density, float samples_per_node, Samples& samples, int threads);
} // namespace fresco::poisson
