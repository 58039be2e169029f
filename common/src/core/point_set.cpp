// SPDX-License-Identifier: BSD-3-Clause
#include <fresco/core/point_set.h>
#include <fresco/core/require.h>
namespace fresco {
namespace {
/// Columns of `b` behind those of `a`, in the memory of `a` where that can grow; nothing unless both have some.
template <typename Matrix>
void append(Matrix& a, const Matrix& b)
{
  const Index count = a.cols();
  const bool keep = count > 0 && b.cols() > 0;
  a.conservativeResize(Eigen::NoChange, keep ? count + b.cols() : 0);
  if (keep)
    a.rightCols(b.cols()) = b;
}

void append(Eigen::VectorXf& a, const Eigen::VectorXf& b)
{
  const Index count = a.size();
  const bool keep = count > 0 && b.size() > 0;
  a.conservativeResize(keep ? count + b.size() : 0);
  if (keep)
    a.tail(b.size()) = b;
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
  PointSet result = a;
  appendPoints(result, b);
  return result;
}

void appendPoints(PointSet& a, const PointSet& b)
{
  validatePointSet(a);
  validatePointSet(b);
  if (b.size() == 0)
    return;
  if (a.size() == 0) {
    a = b;
    return;
  }
  const Eigen::Vector3d shift = b.origin - a.origin;
  const Points b_viewpoints = shifted(b.viewpoints, shift);
  if (a.viewpoints.cols() == 0 || b_viewpoints.cols() == 0) {
    a.viewpoints.resize(3, 0);
  } else if (!sameViewpoint(a, b_viewpoints)) {
    a.viewpoints = expandedViewpoints(a);
    append(a.viewpoints, b_viewpoints.cols() == 1 ? Points(b_viewpoints.replicate(1, b.size())) : b_viewpoints);
  }
  append(a.points, shifted(b.points, shift));
  append(a.normals, b.normals);
  append(a.colors, b.colors);
  append(a.intensities, b.intensities);
  append(a.confidences, b.confidences);
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
