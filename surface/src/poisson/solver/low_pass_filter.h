// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/node_field.h"
#include "poisson/samples/samples.h"
#include <vector>
namespace fresco::poisson {
/// Takes waves out of chi that the samples do not sustain: those about as short as the cells of a depth, where samples
/// are sparse against these cells or noisy. chi becomes
///
///   chi - w (1 - S)^2 chi,   S = (1 2 1) / 4 along each axis,
///
/// with w the strength at the node's brick. Quadratic functions stay, so that curved surfaces do not shrink. Of a wave
/// that changes sign from node to node 1 - w is left. Nodes with a missing cell around them keep their values, so chi
/// stays continuous across depths.
class LowPassFilter {
public:
  /// @param samples of the level's depth or finer
  /// @param finest  depth whose cells are the unit of the samples' positions
  LowPassFilter(const BrickLevel& level, const SampleLevel& samples, int finest, int threads);

  /// @param spare of the same size as `chi`; overwritten
  void apply(NodeField& chi, NodeField& spare) const;

  /// 0..1, by brick
  const std::vector<float>& strengths() const { return strengths_; }

private:
  /// result += factor (1 - S) field at the own nodes of a brick
  void addHighPass(const Neighbors& neighbors, const NodeField& field, float factor, float* result) const;
  const BrickLevel& level_;
  int threads_;
  std::vector<float> strengths_;
};
} // namespace fresco::poisson
