// SPDX-License-Identifier: BSD-3-Clause
#include "tracking_map.h"
namespace fresco::tracking {
KeyFrameEdge edgeOf(Index a, Index b, const DenseAlignment& found)
{
  const Eigen::Isometry3d& T = found.T_reference_current;
  // The alignment moves b by a motion in the frame of a; the graph's errors are in the frame of b.
  Matrix6d carried = Matrix6d::Zero();
  carried.topLeftCorner<3, 3>() = carried.bottomRightCorner<3, 3>() = T.linear();
  carried.bottomLeftCorner<3, 3>() = skew(T.translation()) * T.linear();
  KeyFrameEdge edge{a, b, T, found.overlap};
  edge.information = carried.transpose() * found.information * carried;
  return edge;
}

KeyFrameEdges alignBothWays(const TrackingMap& map, const KeyFrameEdge& guess, int coarsest,
                            const ReferenceFrame& reference_a)
{
  const RgbdPyramid &a = map.key_frames[guess.a].pyramid, &b = map.key_frames[guess.b].pyramid;
  AlignmentOptions options;
  options.coarsest = coarsest;
  options.threads = 1; // pairs run side by side
  const DenseAlignment forth = alignDense(reference_a, b, map.cameras, guess.T_a_b, options);
  if (!isAligned(forth))
    return {};
  options.coarsest = std::min(coarsest, 1);
  const DenseAlignment back =
      alignDense(makeReference(b, map.cameras), a, map.cameras, forth.T_reference_current.inverse(), options);
  const Eigen::Isometry3d loop = forth.T_reference_current * back.T_reference_current;
  constexpr double same = 0.03; // metres, radian
  if (!isAligned(back) || loop.translation().norm() > same || Eigen::AngleAxisd(loop.linear()).angle() > same)
    return {};
  return {edgeOf(guess.a, guess.b, forth), edgeOf(guess.b, guess.a, back)};
}

KeyFrameEdges alignBothWays(const TrackingMap& map, const KeyFrameEdge& guess, int coarsest)
{
  return alignBothWays(map, guess, coarsest, makeReference(map.key_frames[guess.a].pyramid, map.cameras));
}
} // namespace fresco::tracking
