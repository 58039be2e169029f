// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/alignment/core/camera_alignment.h>
#include <fresco/filters/core/bilateral_normals.h>
#include <fresco/filters/core/mixed_pixels.h>
#include <fresco/filters/core/oriented_normals.h>
#include <fresco/filters/core/outliers.h>
#include <fresco/registration/core/scan_registration.h>
#include <fresco/surface/core/depth_fusion.h>
#include <fresco/surface/core/normal_filtering.h>
#include <fresco/surface/core/volumetric_reconstruction.h>
#include <fresco/texture/core/texture_reconstruction.h>
#include <fresco/tracking/core/rgbd_tracking.h>
#include <string>
#include <utility>
#include <vector>
namespace fresco::model {
/// Options of the stages' cores, as the chain sets them, with what the user asked for.
struct StageOptions {
  ScanRegistrationOptions registration;
  MixedPixelOptions mixed_pixels;
  OutlierOptions outliers;
  NormalOptions normals;
  BilateralOptions smoothing;
  DepthFusionOptions fusion;
  RgbdTrackingOptions tracking;
  VolumetricOptions reconstruction;
  NormalFilteringOptions optimization;
  CameraAlignmentOptions alignment;
  TextureOptions texture;

  /// @param threads of all of them
  /// @param asked   "STAGE.OPTION" and value; truth values are 0 and 1
  /// @throws std::invalid_argument naming an option that is none, with those of its stage, or a value that is no number
  StageOptions(int threads, const std::vector<std::pair<std::string, std::string>>& asked);
};
} // namespace fresco::model
