// SPDX-License-Identifier: BSD-3-Clause
#include "tracking/odometry.h"
#include <algorithm>
namespace fresco::tracking {
namespace {
constexpr double least_depth_share = 0.05; // of the pixels: less holds no pose

bool isTracked(const DenseAlignment& found)
{
  return found.overlap >= 0.3 && found.agreement >= 0.6;
}

bool isFar(const DenseAlignment& found)
{
  const Eigen::Isometry3d& T = found.T_reference_current;
  return found.overlap < 0.75 || Eigen::AngleAxisd(T.linear()).angle() > 0.26 || T.translation().norm() > 0.25;
}
} // namespace

void Odometry::add(Index frame, RgbdPyramid pyramid)
{
  if (pyramid.depth_share < least_depth_share)
    return;
  if (current_ >= 0 && track(frame, pyramid)) {
    if (isFar(last_)) {
      const Index from = current_;
      const DenseAlignment found = last_;
      const Eigen::Isometry3d velocity = velocity_;
      makeKeyFrame(frame, std::move(pyramid));
      velocity_ = velocity;
      map_.edges.push_back({from, current_, found.T_reference_current, found.information, found.overlap, found.rms});
    }
    return;
  }
  makeKeyFrame(frame, std::move(pyramid));
}

bool Odometry::track(Index frame, const RgbdPyramid& pyramid)
{
  AlignmentOptions options;
  options.threads = threads_;
  last_ = alignDense(reference_, pyramid, map_.cameras, T_key_last_ * velocity_, options);
  if (!isTracked(last_))
    last_ = alignDense(reference_, pyramid, map_.cameras, T_key_last_, options);
  if (!isTracked(last_))
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
