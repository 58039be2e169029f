// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/node_field.h"
#include "poisson/samples.h"
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

  /// @param depth, brick brick of the octree in or next to which the position lies
  /// @param position     in cells of the finest depth
  Estimate at(int depth, Index brick, const Eigen::Vector3f& position) const;

private:
  float weightAt(int depth, Index brick, const Eigen::Vector3f& position) const;
  const Octree* tree_;
  std::vector<NodeField> fields_; ///< by depth
};

/// Sets depth and area (until now the weight) of each sample.
/// @param samples_per_node see VolumetricOptions
void estimateDensity(const Octree& tree, const Density& density, float samples_per_node, Samples& samples, int threads);
} // namespace fresco::poisson
