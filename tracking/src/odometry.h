// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "tracking_map.h"
namespace fresco::tracking {
/// Frame after frame: each is aligned with the last key frame; where too little of that is left in sight, the frame
/// becomes one. A frame that cannot be aligned becomes a key frame, too, and is joined to the key frame that looks like
/// it; if there is none, it starts a new submap.
class Odometry {
public:
  Odometry(TrackingMap& map, int threads) : map_(map), threads_(threads) {}

  /// @param frame number in the video, ascending
  void add(Index frame, RgbdPyramid pyramid);

private:
  bool track(Index frame, const RgbdPyramid& pyramid);
  void relocalize();
  void makeKeyFrame(Index frame, RgbdPyramid pyramid);

  TrackingMap& map_;
  int threads_;
  ReferenceFrame reference_; ///< of the last key frame
  Eigen::Isometry3d T_key_last_ = Eigen::Isometry3d::Identity(), velocity_ = Eigen::Isometry3d::Identity();
  DenseAlignment last_;
  Index current_ = -1, last_frame_ = -1; ///< key frame; frame of the video
};
} // namespace fresco::tracking
