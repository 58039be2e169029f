// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/types.h>
#include <vector>
namespace fresco {
/// Points with what is known of them, structure of arrays. Attributes are empty where there are none.
struct FRESCO_EXPORT PointSet {
  Points points;               ///< 3xN, relative to `origin`; may hold non-finite points
  Points normals;              ///< 3xN, pointing to the free side, or 3x0
  Colors colors;               ///< 3xN, or 3x0
  Eigen::VectorXf intensities; ///< N, or 0
  Eigen::VectorXf confidences; ///< N, >= 0, or 0
  Points viewpoints;           ///< 3xN where each point was seen from, 3x1 one for all, or 3x0 unknown
  Eigen::Vector3d origin = Eigen::Vector3d::Zero(); ///< world = origin + point: keeps large coordinates exact

  Index size() const { return points.cols(); }
  bool hasNormals() const { return normals.cols() > 0; }
};

/// @throws std::invalid_argument unless every attribute has 0 or N columns (viewpoints also 1)
FRESCO_EXPORT void validatePointSet(const PointSet& set);

/// Those that are finite, ascending.
inline std::vector<Index> finiteColumns(const Points& points)
{
  std::vector<Index> finite;
  for (Index i = 0; i < points.cols(); ++i)
    if (points.col(i).allFinite())
      finite.push_back(i);
  return finite;
}

/// The points named by `indices`, in that order, with all attributes.
/// @throws std::invalid_argument if an index is out of range
FRESCO_EXPORT PointSet selectPoints(const PointSet& set, const std::vector<Index>& indices);

/// `a` followed by `b`, in the frame (origin) of `a`. An attribute is kept where both have it.
FRESCO_EXPORT PointSet mergePoints(const PointSet& a, const PointSet& b);

/// The same in place, which needs less memory. `b` is another object than `a`.
FRESCO_EXPORT void appendPoints(PointSet& a, const PointSet& b);

/// R p + t for points and viewpoints, R n for normals; `origin` is folded in and becomes zero.
/// @param T_target_source 4x4 rigid
FRESCO_EXPORT PointSet transformPoints(const PointSet& set, const Eigen::Matrix4d& T_target_source);
} // namespace fresco
