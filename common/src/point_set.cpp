// SPDX-License-Identifier: BSD-3-Clause
#include <fresco/common/point_set.h>
#include <fresco/common/require.h>
namespace fresco {
namespace {
template <typename Matrix>
Matrix joined(const Matrix& a, const Matrix& b, bool keep)
{
  Matrix result(a.rows(), keep ? a.cols() + b.cols() : 0);
  if (keep)
    result << a, b;
  return result;
}

Points expandedViewpoints(const PointSet& set)
{
  return set.viewpoints.cols() == 1 ? Points(set.viewpoints.replicate(1, set.size())) : set.viewpoints;
}

Points shifted(const Points& points, const Eigen::Vector3d& shift)
{
  if (shift.isZero())
    return points;
  return (points.cast<double>().colwise() + shift).cast<float>();
}

/// Both sets saw everything from one and the same place.
bool sameViewpoint(const PointSet& a, const Points& b_viewpoints)
{
  return a.viewpoints.cols() == 1 && b_viewpoints.cols() == 1 && a.viewpoints == b_viewpoints;
}
} // namespace

void validatePointSet(const PointSet& set)
{
  const auto check = [&](Index count, const char* name) {
    require(count == 0 || count == set.size(), "points: ", set.size(), " points, ", count, " ", name);
  };
  check(set.normals.cols(), "normals");
  check(set.colors.cols(), "colours");
  check(set.intensities.size(), "intensities");
  check(set.confidences.size(), "confidences");
  if (set.viewpoints.cols() != 1)
    check(set.viewpoints.cols(), "viewpoints");
}

PointSet selectPoints(const PointSet& set, const std::vector<Index>& indices)
{
  validatePointSet(set);
  for (const Index i : indices)
    require(i >= 0 && i < set.size(), "points: index ", i, " of ", set.size());
  PointSet result;
  result.origin = set.origin;
  result.points = set.points(Eigen::all, indices);
  if (set.normals.cols() > 0)
    result.normals = set.normals(Eigen::all, indices);
  if (set.colors.cols() > 0)
    result.colors = set.colors(Eigen::all, indices);
  if (set.intensities.size() > 0)
    result.intensities = set.intensities(indices);
  if (set.confidences.size() > 0)
    result.confidences = set.confidences(indices);
  if (set.viewpoints.cols() == 1)
    result.viewpoints = set.viewpoints;
  else if (set.viewpoints.cols() > 1)
    result.viewpoints = set.viewpoints(Eigen::all, indices);
  return result;
}

PointSet mergePoints(const PointSet& a, const PointSet& b)
{
  validatePointSet(a);
  validatePointSet(b);
  if (b.size() == 0)
    return a;
  const Eigen::Vector3d shift = a.size() > 0 ? Eigen::Vector3d(b.origin - a.origin) : Eigen::Vector3d::Zero();
  if (a.size() == 0)
    return b;
  const auto both = [](Index x, Index y) { return x > 0 && y > 0; };
  PointSet result;
  result.origin = a.origin;
  result.points = joined(a.points, shifted(b.points, shift), true);
  result.normals = joined(a.normals, b.normals, both(a.normals.cols(), b.normals.cols()));
  result.colors = joined(a.colors, b.colors, both(a.colors.cols(), b.colors.cols()));
  const bool intensities = both(a.intensities.size(), b.intensities.size());
  if (intensities) {
    result.intensities.resize(result.size());
    result.intensities << a.intensities, b.intensities;
  }
  if (both(a.confidences.size(), b.confidences.size())) {
    result.confidences.resize(result.size());
    result.confidences << a.confidences, b.confidences;
  }
  const Points b_viewpoints = shifted(b.viewpoints, shift);
  if (sameViewpoint(a, b_viewpoints)) {
    result.viewpoints = a.viewpoints;
  } else if (both(a.viewpoints.cols(), b.viewpoints.cols())) {
    const Points b_expanded = b_viewpoints.cols() == 1 ? Points(b_viewpoints.replicate(1, b.size())) : b_viewpoints;
    result.viewpoints = joined(expandedViewpoints(a), b_expanded, true);
  }
  return result;
}

PointSet transformPoints(const PointSet& set, const Eigen::Matrix4d& T_target_source)
{
  require(T_target_source.allFinite(), "points: the transform is not finite");
  const Eigen::Matrix3d R = T_target_source.topLeftCorner<3, 3>();
  const Eigen::Vector3d t = T_target_source.topRightCorner<3, 1>() + R * set.origin;
  const auto moved = [&](const Points& p) { return Points(((R * p.cast<double>()).colwise() + t).cast<float>()); };
  PointSet result = set;
  result.origin.setZero();
  result.points = moved(set.points);
  result.viewpoints = moved(set.viewpoints);
  result.normals = (R * set.normals.cast<double>()).cast<float>();
  return result;
}
} // namespace fresco
