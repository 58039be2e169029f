// SPDX-License-Identifier: BSD-3-Clause
#include "scan/thinning.h"
#include "scan/prepared_scan.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/statistics.h>
namespace fresco::registration {
namespace {
struct CellPoint {
  std::uint64_t cell; // 21 bits per axis
  Index point;
  bool operator<(const CellPoint& other) const { return cell != other.cell ? cell < other.cell : point < other.point; }
};

std::vector<CellPoint> orderByCell(const Points& points, float voxel)
{
  constexpr float grid_limit = 1 << 20; // cells from the centre: a million fits float exactly; beyond lie outliers
  std::vector<CellPoint> order;
  order.reserve(points.cols());
  for (Index i = 0; i < points.cols(); ++i) {
    const Eigen::Array3f cell = (points.col(i).array() / voxel).floor();
    if ((cell.abs() < grid_limit).all()) {
      const Eigen::Array<std::uint64_t, 3, 1> whole = (cell + grid_limit).cast<std::uint64_t>();
      order.push_back({whole[0] << 42 | whole[1] << 21 | whole[2], i});
    }
  }
  std::sort(order.begin(), order.end());
  return order;
}
} // namespace

WorkingCenter workingCenter(const PointSet& scan)
{
  constexpr double far_origin = 6.0; // mean distances of the points from their middle: a scanner with a view of 20
                                     // degrees stands nearer
  for (Index i = 0; i < scan.viewpoints.cols(); ++i)
    if (scan.viewpoints.col(i).allFinite())
      return {scan.origin + scan.viewpoints.col(i).cast<double>(), true, false};
  const std::vector<Index> finite = finiteColumns(scan.points);
  const Index count = finite.size();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Index i : finite)
    sum += scan.points.col(i).cast<double>();
  const Eigen::Vector3d middle = sum / std::max<Index>(1, count);
  double spread = 0.0;
  for (const Index i : finite)
    spread += (scan.points.col(i).cast<double>() - middle).norm() / count;
  if ((scan.origin + middle).norm() > far_origin * spread)
    return {scan.origin + middle, false, false};
  return {Eigen::Vector3d::Zero(), false, true};
}

RawScan finitePoints(const PointSet& scan, const Eigen::Vector3d& center)
{
  const Eigen::Vector3f shift = (scan.origin - center).cast<float>();
  const std::vector<Index> finite = finiteColumns(scan.points);
  const Index given = scan.viewpoints.cols();
  RawScan raw;
  raw.points = scan.points(Eigen::all, finite).colwise() + shift;
  raw.viewpoints.setZero(3, raw.points.cols());
  for (Index k = 0; given > 0 && k < raw.points.cols(); ++k) {
    const Eigen::Vector3f viewpoint = scan.viewpoints.col(given == 1 ? 0 : finite[k]) + shift;
    if (viewpoint.allFinite())
      raw.viewpoints.col(k) = viewpoint;
  }
  if (scan.colors.cols() > 0)
    raw.colors = scan.colors(Eigen::all, finite).cast<float>();
  return raw;
}

RawScan thin(const RawScan& raw, float voxel)
{
  const std::vector<CellPoint> order = orderByCell(raw.points, voxel);
  const bool colored = raw.colors.cols() > 0;
  RawScan thinned{Points(3, raw.points.cols()), Points(3, raw.points.cols()), Points(3, raw.colors.cols())};
  Index count = 0;
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero(), color_sum = Eigen::Vector3f::Zero();
    for (end = begin; end < order.size() && order[end].cell == order[begin].cell; ++end) {
      sum += raw.points.col(order[end].point);
      if (colored)
        color_sum += raw.colors.col(order[end].point);
    }
    const float n = end - begin;
    if (colored)
      thinned.colors.col(count) = color_sum / n;
    thinned.viewpoints.col(count) = raw.viewpoints.col(order[begin].point);
    thinned.points.col(count++) = sum / n;
  }
  thinned.points.conservativeResize(3, count);
  thinned.viewpoints.conservativeResize(3, count);
  thinned.colors.conservativeResize(3, colored ? count : 0);
  return thinned;
}

double scanSize(const PointSet& scan)
{
  constexpr double range_spread = 2.0; // median range / median distance from the centroid: above, the points lie far
                                       // from a viewpoint that may be wrong, and the range says nothing of their extent
  const RawScan raw = finitePoints(scan, workingCenter(scan).place);
  if (raw.points.cols() == 0)
    return 0.0;
  const auto medianOf = [](const Eigen::VectorXf& distances) -> double {
    return median(std::vector<float>(distances.data(), distances.data() + distances.size()));
  };
  const Eigen::Vector3f mean = raw.points.cast<double>().rowwise().mean().cast<float>();
  const double range = medianOf((raw.points - raw.viewpoints).colwise().norm()),
               spread = medianOf((raw.points.colwise() - mean).colwise().norm());
  return spread > 0.0 ? std::min(range, range_spread * spread) : range;
}

double fittingVoxel(const PointSet& scan, double least)
{
  constexpr double points_per_cell = 1.5; // on average, at least: with one, cells would be no wider than the spacing
  const RawScan raw = finitePoints(scan, workingCenter(scan).place);
  double voxel = least;
  for (Index count = raw.points.cols(); count > fewest_points && count * points_per_cell > raw.points.cols();
       voxel *= std::cbrt(2.0))
    count = thin(raw, voxel).points.cols();
  return voxel;
}

double narrowness(const PointSet& scan)
{
  const RawScan raw = finitePoints(scan, workingCenter(scan).place);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Index i = 0; i < raw.points.cols(); ++i)
    sum += (raw.points.col(i) - raw.viewpoints.col(i)).cast<double>().stableNormalized();
  return raw.points.cols() > 0 ? sum.norm() / raw.points.cols() : 0.0;
}

Thinning::Thinning(double voxel, double size, double narrowness)
{
  constexpr double narrow_view = 0.6;                      // a cone of 78 degrees to each side; panoramas have 0 to 0.4
  constexpr double coarsest_share = 8.0 / voxels_per_size; // of a scan's size: what dense scans have
  constexpr double least_ratio = 1.25; // of one level's cells to the next finer ones: below, levels repeat each other
  const double fitting = std::clamp(std::cbrt(coarsest_share * size / voxel), least_ratio, 2.0);
  const double ratio = narrowness > narrow_view ? fitting : 2.0;
  for (float& edge : voxels) {
    edge = voxel;
    voxel *= ratio;
  }
}
} // namespace fresco::registration
