// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/octree.h"
#include "poisson/solver/free_places.h"
#include "poisson/solver/screening.h"
#include <vector>
namespace fresco::poisson {
/// The system A x = b of one octree depth (see screening.h), matrix-free: the constant stencil of the Laplacian in hat
/// functions, divided by the cell side, and the samples in the cells around a node. Nodes with a missing cell around
/// them are no unknowns: they keep the value interpolated from the coarser depth.
class LevelSystem {
public:
  /// @param samples  of the level's depth or finer
  /// @param expected of the samples, see expectedValues()
  /// @param finest   depth whose cells are the unit of the samples' positions
  LevelSystem(const BrickLevel& level, const SampleLevel& samples, Array<float>&& expected, int finest,
              float point_weight, int threads);

  /// Gauss-Seidel sweeps. The bricks of one colour are independent of each other, so the result does not depend on the
  /// number of threads.
  void smooth(const NodeField& b, int iterations, NodeField& x) const;

  /// Smooths once more where chi says solid and beams say free, with chi not below a bound at these nodes (projected
  /// Gauss-Seidel: Cryer 1971, "The solution of a quadratic programming problem using systematic overrelaxation").
  /// Nothing changes where the two agree. Nodes close to samples are left as they are.
  void keepFree(const FreePlaces& places, const NodeField& b, int iterations, NodeField& x);

  /// Squared norms of b - A x and of b over the unknowns; below depth 8 over a sample of them.
  struct Norms {
    double residual = 0, right = 0;
  };
  Norms residual(const NodeField& b, const NodeField& x) const;

  /// A step of the method of multipliers (Hestenes 1969, Powell 1969) for the constraints chi(p_i) = e_i, what sample i
  /// expects: adds weight (e_i - chi(p_i)) B_j(p_i) at the nodes j around each sample that is isolated at this depth.
  /// The finer depths do not see such a sample between their own, so what it still lacks goes into their right-hand
  /// sides.
  void addMultiplierUpdate(const NodeField& x, NodeField& right) const;

private:
  struct Block;
  void assemble(Index brick, const Neighbors& neighbors, Block& block) const;
  void load(Index brick, const NodeField& b, const NodeField& x, Block& block) const;
  void findBounded(const FreePlaces& places, const NodeField& x);
  bool isNearSample(const Neighbors& neighbors, const Eigen::Vector3f& position) const;
  void smoothBrick(Index brick, const NodeField& b, int sweeps, NodeField& x) const;

  const BrickLevel& level_;
  SampleRanges ranges_;
  const SampleLevel& samples_;
  float scale_;          ///< cells of the level per finest cell
  Array<float> weights_; ///< see screeningWeights()
  Array<float> expected_;
  MatrixRows laplacian_rows_;
  std::vector<std::uint64_t> bounded_; ///< by brick, bits ownIndex(): see keepFree(); empty: none
  int threads_;
};
} // namespace fresco::poisson
