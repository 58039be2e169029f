// SPDX-License-Identifier: BSD-3-Clause
#include "scan/prepared_scan.h"
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
namespace fresco::registration {
namespace {
constexpr Index fewest_points = 50;        // thinned; below, a pose has no redundancy worth the name
constexpr double points_per_cell = 1.5;    // at least, on average, in the finest thinning: sparse scans get wide cells
constexpr int neighbor_count = 16;         // of a normal
constexpr float widest_neighborhood = 6.f; // voxels
constexpr float line_limit = 0.02f;        // second / largest eigenvalue: below, the neighbours lie on a line
constexpr double coherence_limit = 0.7;    // of the free space: below, the viewpoint is not believed
constexpr double range_spread = 2.0; // median range / median distance from the centroid: above, the points lie far off
constexpr double coarsest_share = 8.0 / voxels_per_size; // of a scan's size
constexpr double narrow_view = 0.6;                      // a cone of 78 degrees to each side; panoramas have 0 to 0.4
constexpr double least_ratio = 1.25;                     // of one level's cells to those of the next finer one
constexpr float grid_limit = 1 << 20;                    // cells from the centre; points further out are left out

struct RawScan {
  Points points, viewpoints, colors; // no columns of colours where the scan has none
};

// Finite points relative to the scan's centre, with their viewpoints.
RawScan finitePoints(const PointSet& scan, const Eigen::Vector3d& center)
{
  const Eigen::Vector3f shift = (scan.origin - center).cast<float>();
  const bool colored = scan.colors.cols() > 0;
  RawScan raw{Points(3, scan.size()), Points(3, scan.size()), Points(3, colored ? scan.size() : 0)};
  const bool known = scan.viewpoints.cols() > 0;
  Index count = 0;
  for (Index i = 0; i < scan.size(); ++i) {
    if (!scan.points.col(i).allFinite())
      continue;
    raw.points.col(count) = scan.points.col(i) + shift;
    if (colored)
      raw.colors.col(count) = scan.colors.col(i).cast<float>();
    const Eigen::Vector3f viewpoint =
        known ? Eigen::Vector3f(scan.viewpoints.col(scan.viewpoints.cols() == 1 ? 0 : i) + shift)
              : Eigen::Vector3f((-center).cast<float>());
    raw.viewpoints.col(count++) = viewpoint.allFinite() ? viewpoint : Eigen::Vector3f(Eigen::Vector3f::Zero());
  }
  raw.points.conservativeResize(3, count);
  raw.viewpoints.conservativeResize(3, count);
  raw.colors.conservativeResize(3, colored ? count : 0);
  return raw;
}

// The first finite viewpoint; the scan's origin where none is known.
Eigen::Vector3d workingCenter(const PointSet& scan)
{
  for (Index i = 0; i < scan.viewpoints.cols(); ++i)
    if (scan.viewpoints.col(i).allFinite())
      return scan.origin + scan.viewpoints.col(i).cast<double>();
  return Eigen::Vector3d::Zero();
}

struct CellPoint {
  std::array<std::int32_t, 3> cell;
  Index point;
  bool operator<(const CellPoint& other) const { return cell != other.cell ? cell < other.cell : point < other.point; }
};

// One point per occupied cell: the mean; the viewpoint is that of its first point.
RawScan thin(const RawScan& raw, float voxel)
{
  std::vector<CellPoint> order;
  order.reserve(raw.points.cols());
  for (Index i = 0; i < raw.points.cols(); ++i) {
    const Eigen::Array3f cell = (raw.points.col(i).array() / voxel).floor();
    if ((cell.abs() < grid_limit).all())
      order.push_back(
          {{static_cast<std::int32_t>(cell[0]), static_cast<std::int32_t>(cell[1]), static_cast<std::int32_t>(cell[2])},
           i});
  }
  std::sort(order.begin(), order.end());
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
    if (colored)
      thinned.colors.col(count) = color_sum / static_cast<float>(end - begin);
    thinned.viewpoints.col(count) = raw.viewpoints.col(order[begin].point);
    thinned.points.col(count++) = sum / static_cast<float>(end - begin);
  }
  thinned.points.conservativeResize(3, count);
  thinned.viewpoints.conservativeResize(3, count);
  thinned.colors.conservativeResize(3, colored ? count : 0);
  return thinned;
}

struct LocalPlane {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  float bend = 1.f / 3.f;
};

LocalPlane fitPlane(const Points& points, const Eigen::Vector3f& center, const std::vector<Neighbor>& hits, float reach)
{
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
  int count = 0;
  for (const Neighbor& hit : hits) {
    if (hit.squared_distance > reach * reach)
      break;
    const Eigen::Vector3f d = points.col(hit.index) - center;
    sum += d;
    squares += d * d.transpose();
    ++count;
  }
  if (count < 5)
    return {};
  const float n = count;
  const Eigen::Matrix3f covariance = squares / n - (sum / n) * (sum / n).transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(covariance);
  const Eigen::Vector3f values = solver.eigenvalues().cwiseMax(0.f);
  if (!(values[1] > line_limit * values[2]))
    return {};
  return {solver.eigenvectors().col(0), values[0] / values.sum()};
}

void estimateNormals(ScanLevel& level, int threads)
{
  const Index n = level.points.cols();
  level.normals.resize(3, n);
  level.bend.resize(n);
  parallelRanges(n, threads, [&](Index begin, Index end) {
    std::vector<Neighbor> hits;
    for (Index i = begin; i < end; ++i) {
      const Eigen::Vector3f point = level.points.col(i);
      level.tree->nearest(point, neighbor_count, hits);
      const LocalPlane plane = fitPlane(level.points, point, hits, widest_neighborhood * level.voxel);
      const bool away = plane.normal.dot(level.viewpoints.col(i) - point) < 0.f;
      level.normals.col(i) = away ? Eigen::Vector3f(-plane.normal) : plane.normal;
      level.bend[i] = plane.bend;
    }
  });
}

// Direction of a normal, its sign ignored, as one of 5 x 5 x 5 cells.
std::size_t normalBin(const Eigen::Vector3f& normal)
{
  Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const Eigen::Array3f n = (normal * (normal[axis] < 0.f ? -1.f : 1.f)).array();
  const Eigen::Array3f cell = ((n + 1.f) * 2.5f).floor().min(4.f).max(0.f);
  return static_cast<std::size_t>(cell[0] * 25.f + cell[1] * 5.f + cell[2]);
}

std::uint32_t scramble(std::uint32_t x)
{
  x = (x ^ (x >> 16)) * 0x7feb352dU;
  x = (x ^ (x >> 15)) * 0x846ca68bU;
  return x ^ (x >> 16);
}

// Order in which a direction of normals with m points receives about sqrt(m) of the first places, after the idea of
// Rusinkiewicz & Levoy 2001, "Efficient Variants of the ICP Algorithm": rare directions pin down what common ones leave
// free.
std::vector<Index> sampleOrder(const ScanLevel& level)
{
  std::array<std::vector<Index>, 125> bins;
  for (Index i = 0; i < level.points.cols(); ++i)
    if (level.normals.col(i).squaredNorm() > 0.f && level.bend[i] < 0.1f)
      bins[normalBin(level.normals.col(i))].push_back(i);
  std::vector<std::pair<double, Index>> ranked;
  for (std::vector<Index>& bin : bins) {
    std::sort(bin.begin(), bin.end(), [](Index a, Index b) {
      return scramble(static_cast<std::uint32_t>(a)) < scramble(static_cast<std::uint32_t>(b));
    });
    for (std::size_t k = 0; k < bin.size(); ++k)
      ranked.emplace_back((static_cast<double>(k) + 0.5) / std::sqrt(static_cast<double>(bin.size())), bin[k]);
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<Index> order;
  for (const auto& entry : ranked)
    order.push_back(entry.second);
  return order;
}

ScanLevel buildLevel(const RawScan& raw, float voxel, int threads)
{
  RawScan thinned = thin(raw, voxel);
  ScanLevel level;
  level.voxel = voxel;
  level.points = std::move(thinned.points);
  level.tree = std::make_shared<PointTree>(level.points, threads);
  level.viewpoints = std::move(thinned.viewpoints);
  level.colors = std::move(thinned.colors);
  estimateNormals(level, threads);
  level.samples = sampleOrder(level);
  return level;
}
} // namespace

double scanSize(const PointSet& scan)
{
  const RawScan raw = finitePoints(scan, workingCenter(scan));
  if (raw.points.cols() == 0)
    return 0.0;
  const auto medianOf = [](const Eigen::VectorXf& distances) {
    std::vector<float> values(distances.data(), distances.data() + distances.size());
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return static_cast<double>(values[values.size() / 2]);
  };
  const Eigen::Vector3f mean = raw.points.cast<double>().rowwise().mean().cast<float>();
  const double range = medianOf((raw.points - raw.viewpoints).colwise().norm()),
               spread = medianOf((raw.points.colwise() - mean).colwise().norm());
  return spread > 0.0 ? std::min(range, range_spread * spread) : range;
}

double fittingVoxel(const PointSet& scan, double least)
{
  const RawScan raw = finitePoints(scan, workingCenter(scan));
  double voxel = least;
  for (Index count = raw.points.cols();
       count > fewest_points && static_cast<double>(count) * points_per_cell > static_cast<double>(raw.points.cols());
       voxel *= std::cbrt(2.0))
    count = thin(raw, static_cast<float>(voxel)).points.cols();
  return voxel;
}

void distrustViewpoint(PreparedScan& scan)
{
  scan.oriented = false;
  scan.free_space = {};
  scan.twins.clear();
  const Eigen::Vector3f middle = scan.levels.front().points.rowwise().mean();
  for (ScanLevel& level : scan.levels)
    for (Index i = 0; i < level.points.cols(); ++i)
      if (level.normals.col(i).dot(middle - level.points.col(i)) < 0.f)
        level.normals.col(i) *= -1.f;
}

double narrowness(const PointSet& scan)
{
  const RawScan raw = finitePoints(scan, workingCenter(scan));
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Index i = 0; i < raw.points.cols(); ++i)
    sum += (raw.points.col(i) - raw.viewpoints.col(i)).cast<double>().stableNormalized();
  return raw.points.cols() > 0 ? sum.norm() / static_cast<double>(raw.points.cols()) : 0.0;
}

Thinning::Thinning(double voxel, double size, double narrowness)
{
  const double fitting = std::clamp(std::cbrt(coarsest_share * size / voxel), least_ratio, 2.0);
  const double ratio = narrowness > narrow_view ? fitting : 2.0;
  for (float& edge : voxels) {
    edge = static_cast<float>(voxel);
    voxel *= ratio;
  }
}

PreparedScan prepareScan(const PointSet& scan, const Thinning& thinning, int threads)
{
  PreparedScan prepared;
  prepared.center = workingCenter(scan);
  prepared.size = scanSize(scan);
  RawScan raw = finitePoints(scan, prepared.center);
  if (raw.points.cols() < fewest_points) {
    prepared.problem = concat("only ", raw.points.cols(), " finite points");
    return prepared;
  }
  prepared.free_space = FreeSpace(raw.points, raw.viewpoints, 3.f * thinning.voxels[0]);
  prepared.oriented = prepared.free_space.coherence() > coherence_limit;
  for (const float voxel : thinning.voxels) {
    prepared.levels.push_back(buildLevel(raw, voxel, threads));
    raw = {prepared.levels.back().points, prepared.levels.back().viewpoints, prepared.levels.back().colors};
  }
  std::reverse(prepared.levels.begin(), prepared.levels.end());
  if (static_cast<Index>(prepared.levels.back().samples.size()) < fewest_points)
    prepared.problem = concat("only ", prepared.levels.back().samples.size(), " points lie on surfaces");
  if (!prepared.oriented)
    prepared.free_space = {};
  return prepared;
}
} // namespace fresco::registration
