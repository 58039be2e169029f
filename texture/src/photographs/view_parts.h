// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/texture/core/texture_reconstruction.h>
namespace fresco::texture {
/// What one camera with an image plane sees: a photograph, or a part of a panorama.
struct ViewPart {
  const TextureView* given;
  int view;           ///< number of what was given
  CameraModel camera; ///< not spherical
  Eigen::Matrix3d R_part_view = Eigen::Matrix3d::Identity();

  bool ofPanorama() const { return given->camera.projection == CameraProjection::spherical; }
};

/// Panoramas as the six sides of a cube, which overlap: depth, homographies and derivatives need an image plane.
std::vector<ViewPart> partsOf(const std::vector<TextureView>& views);

/// With columns of the other end on either side, so that it can be interpolated across the ends.
Image wrapPanorama(const Image& panorama);

/// What the camera of the part would have taken.
/// @param wrapped by wrapPanorama()
Image cutPanorama(const Image& wrapped, const ViewPart& part);
} // namespace fresco::texture
