// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dense_alignment.h"
#include "image_features.h"
#include <fresco/registration/core/pose_graph.h>
namespace fresco::tracking {

struct KeyFrame {
  Index frame = 0; ///< number in the video
  RgbdPyramid pyramid;
  ImageFeatures features;
};

/// Two key frames and their measured relative pose; PoseEdge::information is that of a dense alignment.
using KeyFrameEdge = registration::PoseEdge;
using KeyFrameEdges = registration::PoseEdges;

/// Where a frame was tracked.
struct FramePlace {
  Index key_frame = -1; ///< -1 = lost
  Eigen::Isometry3d T_key_frame = Eigen::Isometry3d::Identity();
};

struct TrackingMap {
  RgbdCameras cameras;
  std::vector<KeyFrame> key_frames;
  KeyFrameEdges edges;
  std::vector<FramePlace, Eigen::aligned_allocator<FramePlace>> frames;
};

/// The edge that a dense alignment of key frame `b` with key frame `a` gives.
KeyFrameEdge edgeOf(Index a, Index b, const DenseAlignment& found);

/// Aligns two key frames densely, each with the other, from a guess. Two edges if both succeed and agree, else none.
/// @param guess its pose is the guess
/// @param coarsest level of the pyramids to begin at
KeyFrameEdges alignBothWays(const TrackingMap& map, const KeyFrameEdge& guess, int coarsest);
KeyFrameEdges alignBothWays(const TrackingMap& map, const KeyFrameEdge& guess, int coarsest,
                            const ReferenceFrame& reference_a);
} // namespace fresco::tracking
