// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "painting/border_offsets.h"
#include "views/visibility.h"
namespace fresco::texture {
/// A view that takes part in a patch's colour.
struct BlendShare {
  int view;
  Eigen::Vector3f weights; ///< at the patch's corners, >= 0; those of all shares of a patch sum to 1 at each corner
  Eigen::Matrix3f offsets; ///< at the corners (columns), added to the view's colour
};

/// Shares of every patch; none for unseen patches.
struct Blend {
  std::vector<Index> begin; ///< P + 1, into `list`
  std::vector<BlendShare> list;

  Index count(Index patch) const { return begin[patch + 1] - begin[patch]; }
};

struct BlendOptions {
  int rounds = 0;    ///< of spreading the views' shares, see blendRounds()
  bool level = true; ///< take away the step between views that is left at their seam, and spread what that changes
  int threads = 0;
  BorderOffsets* border = nullptr; ///< of the tiles of a mesh, where this is one
};

/// Mean length of an edge.
double meanEdge(const PatchMesh& patches);

/// Rounds that let one view pass into the next over a width in mesh units.
int blendRounds(double mean_edge, double width);

/// What is blended.
struct BlendInput {
  const PatchMesh& patches;
  const Candidates& candidates;
  const Eigen::VectorXi& view; ///< P, -1 = unseen
  const Photometry& photometry;
  const std::vector<float>& penalties; ///< octaves, of each candidate: photo-consistency

  /// The candidate of a view that may take part in a seen patch's colours: not one that is much less consistent than the
  /// view chosen.
  const Candidate* usable(Index patch, int other) const
  {
    constexpr float doubtful = 2; // octaves: some 28 grey levels
    const Candidate* at = candidates.find(patch, other);
    if (!at || other == view[patch] || view[patch] < 0)
      return at;
    const auto penalty = [&](const Candidate* c) { return penalties[c - candidates.list.data()]; };
    return penalty(at) < penalty(candidates.find(patch, view[patch])) + doubtful ? at : nullptr;
  }
};

/// Feathers the seams: near them the colours of a patch are made of both views.
Blend blendViews(const BlendInput& input, const BlendOptions& options);
} // namespace fresco::texture
