// SPDX-License-Identifier: BSD-3-Clause
#pragma once
namespace fresco::fusion {
constexpr int brick_side = 8, brick_size = brick_side * brick_side * brick_side;

/// A depth image; pixel centres at integers, rows from the top, 0 = no depth.
struct DepthPixels {
  const float* depth;
  int width, height;
  float fx, fy, cx, cy;
};

/// Where the nodes of a brick lie in the camera's frame.
struct BrickView {
  float first[3];   ///< of the node at the lower corner
  float step[3][3]; ///< one node on along each axis
};

struct VoteSettings {
  float nearest;     ///< depth from which nodes are seen
  float truncation;  ///< of signed distances
  float free_weight; ///< of a vote for free space
  float scale;       ///< of the residuals of votes, Geman & McClure 1987
};

/// Nodes of a brick, x fastest.
struct BrickVotes {
  const float* reference; ///< the mean that votes are weighted by, or null
  float *distance, *weight;
};

struct VoteKernels {
  /// One vote for each node that the image shows. @returns the weight of the votes near a surface
  float (*vote)(const DepthPixels& image, const BrickView& view, const VoteSettings& settings, const BrickVotes& nodes);
};

/// Depth at a pixel: bilinear on a surface, the nearest pixel's beside a jump. Share of the depth, between pixels next to
/// each other: steeper than 80 degrees at 600 pixels.
constexpr float depth_jump = 0.02f;

const VoteKernels& voteKernels();         ///< the fastest ones that this processor runs
const VoteKernels& portableVoteKernels(); ///< those that run everywhere
const VoteKernels* avx2VoteKernels();     ///< null where the processor has no AVX2
} // namespace fresco::fusion
