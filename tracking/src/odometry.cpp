// SPDX-License-Identifier: BSD-3-Clause
#include "odometry.h"
#include "loop_closure.h"
#include <algorithm>
namespace fresco::tracking {
namespace {
constexpr double least_depth_share = 0.05; // of the pixels: less holds no pose

bool isFar(const DenseAlignment& found)
{
  const Eigen::Isometry3d& T = found.T_reference_current;
  return found.overlap < 0.75 || Eigen::AngleAxisd(T.linear()).angle() > 0.26 || T.translation().norm() > 0.25;
}
} // namespace

void Odometry::add(Index frame, RgbdPyramid pyramid)
{
  constexpr Index longest_gap = 5; // frames: after more the motion before says nothing
  if (pyramid.depth_share < least_depth_share)
    return;
  const bool follows = current_ >= 0 && frame - last_frame_ <= longest_gap;
  last_frame_ = frame;
  if (follows && track(frame, pyramid)) {
    if (isFar(last_)) {
      const Index from = current_;
      const DenseAlignment found = last_;
      const Eigen::Isometry3d velocity = velocity_;
      makeKeyFrame(frame, std::move(pyramid));
      velocity_ = velocity;
      map_.edges.push_back(edgeOf(from, current_, found));
    }
    return;
  }
  makeKeyFrame(frame, std::move(pyramid));
  relocalize();
}

void Odometry::relocalize()
{
  for (const Index a : mostAlike(map_.key_frames, map_.key_frames[current_].pyramid))
    if (a < current_)
      if (const KeyFrameEdges edges = alignByFeatures(map_, a, current_); !edges.empty()) {
        map_.edges.insert(map_.edges.end(), edges.begin(), edges.end());
        return;
      }
}

bool Odometry::track(Index frame, const RgbdPyramid& pyramid)
{
  AlignmentOptions options;
  options.threads = threads_;
  last_ = alignDense(reference_, pyramid, map_.cameras, T_key_last_ * velocity_, options);
  if (!isAligned(last_))
    last_ = alignDense(reference_, pyramid, map_.cameras, T_key_last_, options);
  if (!isAligned(last_))
    return false;
  velocity_ = T_key_last_.inverse() * last_.T_reference_current;
  T_key_last_ = last_.T_reference_current;
  map_.frames[frame] = {current_, T_key_last_};
  return true;
}

void Odometry::makeKeyFrame(Index frame, RgbdPyramid pyramid)
{
  current_ = map_.key_frames.size();
  reference_ = makeReference(pyramid, map_.cameras);
  map_.frames[frame] = {current_, Eigen::Isometry3d::Identity()};
  T_key_last_ = velocity_ = Eigen::Isometry3d::Identity();
  ImageFeatures features = findFeatures(pyramid, map_.cameras);
  map_.key_frames.push_back({frame, std::move(pyramid), std::move(features)});
}
} // namespace fresco::tracking
