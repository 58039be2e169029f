// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <fresco/core/export.h>
#include <fresco/core/types.h>
#include <string>
#include <vector>
namespace fresco {
/// How directions become places in the picture, before distortion.
enum class CameraProjection {
  perspective,     ///< the plane z = 1
  fisheye,         ///< equidistant: the distance from the middle is the angle from the axis, radians
  fisheye_in_turn, ///< the same, where tangential and prism terms bend what the radial ones have bent already
  spherical        ///< equirectangular: longitude to the right, latitude downwards, radians; the middle looks along z
};

/// Camera with radial, tangential and thin prism distortion. Perspective: the models OPENCV, FULL_OPENCV and FOV of COLMAP
/// and the frame camera of Metashape; fisheye: OPENCV_FISHEYE and THIN_PRISM_FISHEYE; in turn: RAD_TAN_THIN_PRISM_FISHEYE;
/// simpler models have zeros. Axes: x right, y down, z forward. Pixels: (0,0) is the upper left corner of the upper left
/// pixel, whose centre lies at (0.5, 0.5).
struct CameraModel {
  int width = 0, height = 0;             ///< pixels
  double fx = 0, fy = 0, cx = 0, cy = 0; ///< pixels; spherical: pixels per radian
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0; ///< distortion, dimensionless; none of a spherical camera
  double k3 = 0;                         ///< of r^6
  double k4 = 0, k5 = 0, k6 = 0; ///< perspective: of r^2, r^4, r^6 in the denominator; fisheye: of r^8, r^10, r^12
  double sx1 = 0, sy1 = 0;       ///< thin prism, of r^2
  double sx2 = 0, sy2 = 0;       ///< the same of r^4
  double r8 = 0;                 ///< perspective: of r^8
  double omega =
      0;           ///< perspective: angle of view that is bent to a plane, radians (Devernay & Faugeras 2001); 0 = none
  double skew = 0; ///< pixels to the right for each unit downwards
  CameraProjection projection = CameraProjection::perspective;

  /// Whether it is anything but a pinhole camera.
  bool hasDistortion() const
  {
    bool bent = projection != CameraProjection::perspective; // without jumps: it is asked for every texel
    for (const double value : {k1, k2, p1, p2, k3, k4, k5, k6, sx1, sy1, sx2, sy2, r8, omega, skew})
      bent |= value != 0;
    return bent;
  }
};

/// The spherical camera of a panorama of all directions, `width` twice as many pixels as `height`.
FRESCO_EXPORT CameraModel sphericalCamera(int width, int height);

/// One photograph.
struct View {
  std::string image; ///< file name, relative to the folder of images
  int camera = 0;    ///< index into CameraSet::cameras
  Eigen::Isometry3d T_camera_world = Eigen::Isometry3d::Identity();

  Eigen::Vector3d center() const { return -(T_camera_world.linear().transpose() * T_camera_world.translation()); }
};

struct CameraSet {
  std::vector<CameraModel> cameras;
  std::vector<View> views;
};

/// Where a photograph shows a point.
struct Observation {
  int view = 0;          ///< index into CameraSet::views
  Eigen::Vector2d pixel; ///< NaN = not known
};

/// A point that structure from motion found in several photographs.
struct SparsePoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero(); ///< in the frame of the views
  Eigen::Matrix<std::uint8_t, 3, 1> color = Eigen::Matrix<std::uint8_t, 3, 1>::Zero();
  double error = 0; ///< mean distance of its projections from the observations, pixels; negative = not known
  std::vector<Observation> track;
};
using SparsePoints = std::vector<SparsePoint>;

/// @throws std::invalid_argument unless the image has 1..1,000,000 pixels a side, the focal lengths are 1e-3..1e6 times as
///         long, the centre is within 1e6 of that, and distortion within 1e6: what no camera exceeds, and what can be
///         computed with
FRESCO_EXPORT void validateCamera(const CameraModel& camera);

/// Pixel of a point given in the camera's frame; z must be positive in perspective. Elsewhere the point is not at the
/// origin.
FRESCO_EXPORT Eigen::Vector2d project(const CameraModel& camera, const Eigen::Vector3d& point);

/// Direction of length 1 in the camera's frame that `pixel` looks along; distortion is inverted iteratively.
FRESCO_EXPORT Eigen::Vector3d direction(const CameraModel& camera, const Eigen::Vector2d& pixel);

/// The same with z = 1. Directions of a fisheye camera more than 89 degrees from its axis are taken to 89 degrees.
/// @throws std::invalid_argument for a spherical camera
FRESCO_EXPORT Eigen::Vector3d unproject(const CameraModel& camera, const Eigen::Vector2d& pixel);
} // namespace fresco
