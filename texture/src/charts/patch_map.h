// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "photographs/projector.h"
#include "views/patch_mesh.h"
#include <fresco/core/simd.h>
namespace fresco::texture {
/// Four of them.
struct Pixels {
  simd::Float4 x, y;
};

/// From a chart's texels to a photograph's pixels over one patch: exact for a pinhole, with the lens' distortion linear
/// over the patch. Places are given in texels from `origin` so that single precision suffices.
class PatchMap {
public:
  /// @param corners of the patch in the chart's texels
  PatchMap(const PatchMesh& patches, Index patch, const Eigen::Matrix<double, 2, 3>& corners,
           const Eigen::Vector2d& origin);

  /// Sets the photograph. @return false where a corner is not in front of the camera
  bool look(const Projector& view);

  Eigen::Vector2f pixel(float x, float y) const
  {
    const float scale = 1 / (camera_(2, 0) * x + camera_(2, 1) * y + camera_(2, 2));
    return {(camera_(0, 0) * x + camera_(0, 1) * y + camera_(0, 2)) * scale + lens_(0, 0) * x + lens_(0, 1) * y +
                lens_(0, 2),
            (camera_(1, 0) * x + camera_(1, 1) * y + camera_(1, 2)) * scale + lens_(1, 0) * x + lens_(1, 1) * y +
                lens_(1, 2)};
  }

  /// Pixels of places of a row, four at a time.
  class Row {
  public:
    Row(const PatchMap& map, float y)
        : camera_(map.camera_.col(1) * y + map.camera_.col(2)), camera_step_(map.camera_.col(0)),
          lens_(map.lens_.col(1) * y + map.lens_.col(2)), lens_step_(map.lens_.col(0))
    {}

    Pixels pixels(const simd::Float4& x) const
    {
      const simd::Float4 scale = 1 / (camera_step_[2] * x + camera_[2]);
      return {(camera_step_[0] * x + camera_[0]) * scale + lens_step_[0] * x + lens_[0],
              (camera_step_[1] * x + camera_[1]) * scale + lens_step_[1] * x + lens_[1]};
    }

  private:
    Eigen::Vector3f camera_, camera_step_;
    Eigen::Vector2f lens_, lens_step_;
  };

  /// Of the surface, along the camera's axis.
  float inverseDepth(float x, float y) const { return 1 / (camera_(2, 0) * x + camera_(2, 1) * y + camera_(2, 2)); }

  /// Weights of the patch's corners at a place; they sum to 1, negative ones outside.
  Eigen::Vector3f weights(float x, float y) const { return weights_ * Eigen::Vector3f(x, y, 1.f); }
  /// Pixels per texel at a place: columns are the steps of one texel to the right and down.
  Eigen::Matrix2f steps(float x, float y) const;
  Eigen::Matrix2f middleSteps() const; ///< in the middle of the patch
  Eigen::Matrix<float, 2, 3> cornerPixels() const;
  /// Place with the given weights of the corners, texels from the origin.
  Eigen::Vector2f place(const Eigen::Vector3f& weights) const { return corners_ * weights; }

private:
  Eigen::Matrix3d points_;  ///< corners in mesh coordinates, columns
  Eigen::Matrix3d inverse_; ///< corner weights = inverse * (x, y, 1)
  Eigen::Matrix<float, 2, 3> corners_;
  Eigen::Matrix3f weights_, camera_; ///< camera: (x, y, 1) to the homogeneous pixel
  Eigen::Matrix<float, 2, 3> lens_;
};
} // namespace fresco::texture
