// SPDX-License-Identifier: BSD-3-Clause
#include "draw_mesh.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/statistics.h>
namespace fresco::rendering {
namespace {
/// Values that 2 % of the finite ones are below and above: single wild values must not decide on the colours.
std::pair<float, float> usualRange(const Eigen::VectorXf& values)
{
  std::vector<float> finite;
  for (const float value : values)
    if (std::isfinite(value))
      finite.push_back(value);
  if (finite.empty())
    return {0.f, 1.f};
  const auto at = [&](double share) {
    const Index rank = share * (finite.size() - 1);
    return rankedValue(finite, rank);
  };
  const float low = at(0.02), high = at(0.98);
  return {low, high > low ? high : low + 1.f};
}

/// 0..1 per value, by usualRange().
Eigen::ArrayXf relative(const Eigen::VectorXf& values)
{
  const auto [low, high] = usualRange(values);
  const float size = high - low;
  return values.array().unaryExpr([low = low, size](float value) {
    return std::isfinite(value) ? std::clamp((value - low) / size, 0.f, 1.f) : 0.f;
  });
}

/// Between two colours, 0..255.
Colors ramp(const Eigen::ArrayXf& share, const Eigen::Vector3f& from, const Eigen::Vector3f& to)
{
  Colors colors(3, share.size());
  for (Index i = 0; i < share.size(); ++i)
    colors.col(i) = (from + share[i] * (to - from)).cast<std::uint8_t>();
  return colors;
}

Points unitNormals(const Points& normals)
{
  Points unit = normals;
  for (Index i = 0; i < unit.cols(); ++i) {
    const float length = unit.col(i).norm();
    unit.col(i) =
        length > 0 && std::isfinite(length) ? Eigen::Vector3f(unit.col(i) / length) : Eigen::Vector3f::UnitZ();
  }
  return unit;
}
} // namespace

DrawMesh drawPoints(const PointSet& set)
{
  const PointSet finite = selectPoints(set, finiteColumns(set.points));
  DrawMesh drawn;
  drawn.vertices = finite.points;
  drawn.normals = unitNormals(finite.normals);
  if (finite.colors.cols() > 0)
    drawn.colors = finite.colors;
  else if (finite.intensities.size() > 0)
    drawn.colors =
        ramp(relative(finite.intensities), Eigen::Vector3f::Constant(30.f), Eigen::Vector3f::Constant(235.f));
  else if (!finite.hasNormals())
    drawn.colors = ramp(relative(finite.points.row(2).transpose()), {25.f, 50.f, 110.f}, {240.f, 175.f, 80.f});
  return drawn;
}
} // namespace fresco::rendering
