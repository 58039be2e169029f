// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/octree.h"
#include "poisson/samples.h"
#include "poisson/solver/hat_function.h"
namespace fresco::poisson {
/// The screened Poisson system of one octree depth, matrix-free: the constant
/// stencil of the Laplacian in hat functions, divided by the cell side, and the
/// samples that lie in the cells around a node. Nodes with a missing cell
/// around them are not unknowns: they keep the value interpolated from the
/// coarser depth.
class LevelSystem {
public:
  /// @param samples of the level's depth or finer; `finest` is the depth whose
  /// cells are the unit of their positions
  LevelSystem(const BrickLevel& level, const SampleLevel& samples, int finest, float point_weight, int threads);

  /// Gauss-Seidel sweeps; the bricks of one colour are independent of each
  /// other, so the result does not depend on the number of threads. Upper faces
  /// of `x` are up to date afterwards.
  void smooth(const NodeField& b, int iterations, NodeField& x) const;

  /// Squared norms of b - A x and of b over the unknowns.
  struct Norms {
    double residual = 0, right = 0;
  };
  Norms residual(const NodeField& b, const NodeField& x) const;

  /// Adds the pull of the samples on the solution, -point_weight * area *
  /// chi(sample) at the nodes around. Only of samples that are isolated at this
  /// depth: between them finer depths know nothing of the pull, so it goes into
  /// their right-hand sides (a step of the method of multipliers).
  void addPull(const NodeField& x, NodeField& pull) const;

private:
  struct Block;
  void assemble(Index brick, Block& block) const;
  static void addSample(const HatWeights& hat, float weight, Block& block);
  void load(Index brick, const NodeField& b, const NodeField& x, Block& block) const;
  void smoothBrick(Index brick, const NodeField& b, int sweeps, NodeField& x) const;
  void excludeFixed(Index brick, Block& block) const;

  /// A sample at this depth.
  struct Constraint {
    Eigen::Vector3f position; ///< in cells
    float weight;             ///< of chi(position)^2 in the energy
    float isolated;           ///< 1 if the data sustain no more than this depth here, 0 if they sustain a finer one
  };

  const BrickLevel& level_;
  Array<std::uint32_t> begin_;
  Array<Constraint> samples_;
  float laplacian_rows_[27][64];
  int threads_;
};
} // namespace fresco::poisson
