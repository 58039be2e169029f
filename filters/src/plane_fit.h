// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <fresco/common/types.h>
namespace fresco {
/// Weighted sums over points given as offsets from a point nearby, which keeps single precision exact enough.
struct Moments {
  float weight = 0;
  Eigen::Vector3f first = Eigen::Vector3f::Zero();
  float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  void add(const Eigen::Vector3f& offset, float w = 1)
  {
    const Eigen::Vector3f scaled = w * offset;
    weight += w;
    first += scaled;
    xx += scaled.x() * offset.x();
    xy += scaled.x() * offset.y();
    xz += scaled.x() * offset.z();
    yy += scaled.y() * offset.y();
    yz += scaled.y() * offset.z();
    zz += scaled.z() * offset.z();
  }
};

/// Least squares plane through points.
struct PlaneFit {
  enum Shape { point, line, plane };
  Eigen::Vector3f center = Eigen::Vector3f::Zero(); ///< offset from the point nearby
  Eigen::Vector3f normal = Eigen::Vector3f::Zero(); ///< unit; of a line its direction; of coincident points zero
  float variance = 0;                               ///< mean squared distance to the plane, length^2
  float curvature = 0;                              ///< share of the smallest of the three variances, 0..1/3
  Shape shape = point;

  float distance(const Eigen::Vector3f& offset) const { return normal.dot(offset - center); }
};

PlaneFit fitPlane(const Moments& moments);
} // namespace fresco
