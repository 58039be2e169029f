// SPDX-License-Identifier: BSD-3-Clause
#include "plan/surfaces.h"
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <unordered_set>
namespace fresco::plan {
using Eigen::Vector3d;
using Eigen::Vector3f;

namespace {
constexpr double spread = 0.05;         // metres between level samples
constexpr double bin = 0.02;            // metres, of the histogram of heights
constexpr double standing_eye = 1.5;    // metres above the floor: over desks, below the upper edge of doors and windows
constexpr double most_storey = 6;       // metres from floor to ceiling
constexpr double least_clearance = 0.3; // metres between the cut and floor or ceiling

/// How much level surface there is at each height.
class HeightHistogram {
public:
  HeightHistogram(const LevelSamples& level, int facing) : level_(level), facing_(facing), low_(level.lowest - 2 * bin)
  {
    counts_.assign(static_cast<std::size_t>((level.highest - low_) / bin) + 4, 0);
    for (std::size_t i = 0; i < level.points.size(); ++i)
      if (level.facing[i] * facing >= 0)
        ++counts_[static_cast<std::size_t>((level.points[i].z() - low_) / bin)];
  }

  /// Heights in a range at which there is the most, within three bins, and at least `share` of the most; ascending.
  std::vector<double> peaks(double from, double to, double share) const
  {
    std::vector<double> found;
    const double least = share * most(from, to);
    for (std::size_t b = 2; b + 2 < counts_.size(); ++b)
      if (inRange(b, from, to) && near(b) > 0 && near(b) >= least && near(b) >= near(b - 1) && near(b) > near(b + 1) &&
          near(b) >= near(b - 2))
        found.push_back(exactly(heightOf(b)));
    return found;
  }

  Index most(double from, double to) const
  {
    Index most = 0;
    for (std::size_t b = 1; b + 1 < counts_.size(); ++b)
      if (inRange(b, from, to))
        most = std::max(most, near(b));
    return most;
  }

private:
  double exactly(double peak) const
  {
    std::vector<float> heights;
    for (std::size_t i = 0; i < level_.points.size(); ++i)
      if (level_.facing[i] * facing_ >= 0 && std::abs(level_.points[i].z() - peak) < 2 * bin)
        heights.push_back(level_.points[i].z());
    return mainHeight(heights);
  }

  double heightOf(std::size_t b) const { return low_ + (b + 0.5) * bin; }
  bool inRange(std::size_t b, double from, double to) const { return heightOf(b) >= from && heightOf(b) <= to; }
  Index near(std::size_t b) const { return counts_[b - 1] + counts_[b] + counts_[b + 1]; }
  const LevelSamples& level_;
  int facing_;
  double low_;
  std::vector<Index> counts_;
};

/// Points of an upright lattice that lie on a face.
void sampleFace(const Vector3d& a, const Vector3d& b, const Vector3d& c, LevelSamples& out)
{
  const Vector3d normal = (b - a).cross(c - a);
  if (!(std::abs(normal.z()) > 0.9 * normal.norm()) || normal.z() == 0)
    return;
  const auto cross = [](const Vector3d& p, const Vector3d& q, double x, double y) {
    return (q.x() - p.x()) * (y - p.y()) - (q.y() - p.y()) * (x - p.x());
  };
  const Eigen::Array2d low = a.head<2>().cwiseMin(b.head<2>()).cwiseMin(c.head<2>()).array() / spread;
  const Eigen::Array2d high = a.head<2>().cwiseMax(b.head<2>()).cwiseMax(c.head<2>()).array() / spread;
  for (double i = std::ceil(low.y()); i <= high.y(); ++i)
    for (double j = std::ceil(low.x()); j <= high.x(); ++j) {
      const double x = j * spread, y = i * spread;
      const double wa = cross(b, c, x, y) / normal.z(), wb = cross(c, a, x, y) / normal.z();
      if (wa < 0 || wb < 0 || wa + wb > 1)
        continue;
      out.points.emplace_back(x, y, wa * a.z() + wb * b.z() + (1 - wa - wb) * c.z());
      out.facing.push_back(normal.z() > 0 ? 1 : -1);
    }
}
} // namespace

Eigen::Matrix3d turnToZ(const Vector3d& up)
{
  const Vector3d axis = up.cross(Vector3d::UnitZ());
  const Vector3d about = axis.norm() > 0 ? Vector3d(axis.normalized()) : Vector3d::UnitX();
  return Eigen::AngleAxisd(std::atan2(axis.norm(), up.z()), about).toRotationMatrix();
}

LevelSamples levelSamples(const MeshToCut& mesh)
{
  LevelSamples level;
  level.lowest = std::numeric_limits<double>::infinity(), level.highest = -level.lowest;
  for (Index f = 0; f < mesh.faces.cols(); ++f) {
    const auto corner = [&](int k) -> Vector3d { return mesh.vertices.col(mesh.faces(k, f)).cast<double>(); };
    const Vector3d a = corner(0), b = corner(1), c = corner(2);
    level.lowest = std::min({level.lowest, a.z(), b.z(), c.z()});
    level.highest = std::max({level.highest, a.z(), b.z(), c.z()});
    sampleFace(a, b, c, level);
  }
  return level;
}

LevelSamples levelSamples(const Points& cloud)
{
  LevelSamples level;
  level.lowest = cloud.row(2).minCoeff(), level.highest = cloud.row(2).maxCoeff();
  std::unordered_set<std::uint64_t> taken; // one of each box of 5 x 5 x 2 cm: floors near the scanner count no more
  for (Index i = 0; i < cloud.cols(); ++i) {
    const auto name = [&](int axis, double side) {
      return static_cast<std::uint64_t>(std::llround(std::floor(cloud(axis, i) / side))) & 0x1fffffu;
    };
    if (!taken.insert(name(0, spread) << 42 | name(1, spread) << 21 | name(2, bin)).second)
      continue;
    level.points.push_back(cloud.col(i));
    level.facing.push_back(0);
  }
  return level;
}

double mainHeight(std::vector<float> heights)
{
  if (heights.empty())
    return std::numeric_limits<double>::quiet_NaN();
  std::sort(heights.begin(), heights.end());
  constexpr float window = 0.03f; // metres: noise of a floor
  std::size_t first = 0, best = 0, most = 0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    while (heights[i] - heights[first] > window)
      ++first;
    if (i - first + 1 > most) {
      most = i - first + 1;
      best = first;
    }
  }
  return heights[best + most / 2];
}

Eigen::Matrix3d levellingTurn(const LevelSamples& level)
{
  std::vector<float> heights;
  Vector3d middle = Vector3d::Zero();
  for (const Vector3f& p : level.points) {
    heights.push_back(p.z());
    middle += p.cast<double>() / level.points.size();
  }
  Vector3d plane(0, 0, mainHeight(heights)); // z = plane . (x, y, 1), x and y from the middle
  for (double width = 0.2; width > 0.005 && !heights.empty(); width *= 0.7) {
    Eigen::Matrix3d A = 1e-9 * Eigen::Matrix3d::Identity();
    Vector3d b = 1e-9 * plane;
    for (const Vector3f& p : level.points) {
      const Vector3d row(p.x() - middle.x(), p.y() - middle.y(), 1);
      const double r = (p.z() - plane.dot(row)) / width, weight = 1 / ((1 + r * r) * (1 + r * r));
      A += weight * row * row.transpose();
      b += weight * p.z() * row;
    }
    plane = A.ldlt().solve(b);
  }
  return turnToZ({-plane.x(), -plane.y(), 1});
}

Storey findStorey(const LevelSamples& level, double height)
{
  const HeightHistogram up(level, 1), down(level, -1);
  Storey storey;
  storey.floor = level.lowest;
  if (std::isnan(height)) {
    const std::vector<double> floors = up.peaks(level.lowest, level.highest, 0.3);
    storey.floor = floors.empty() ? level.lowest : floors.front();
    height = std::min(storey.floor + standing_eye, 0.5 * (storey.floor + level.highest));
    if (level.highest - storey.floor > standing_eye + least_clearance)
      height = storey.floor + standing_eye;
  } else {
    const std::vector<double> floors = up.peaks(height - 4, height - least_clearance, 0.6);
    storey.floor = floors.empty() ? level.lowest : floors.back();
  }
  storey.height = height;
  const double above = height + least_clearance, most = storey.floor + most_storey;
  const std::vector<double> ceilings = down.peaks(above, most, 0.6);
  const Index of_floor = up.most(storey.floor - bin, storey.floor + bin);
  storey.has_ceiling = !ceilings.empty() && down.most(above, most) > 0.15 * of_floor;
  storey.ceiling = storey.has_ceiling ? ceilings.front() : std::min(level.highest, most);
  storey.wall_low = storey.has_ceiling ? std::max(height, storey.ceiling - 0.35) : height - 0.1;
  storey.wall_high = storey.has_ceiling ? storey.ceiling - 0.08 : height + 0.1;
  return storey;
}

std::vector<Vector3f> uprightSamples(const MeshToCut& mesh, const Storey& storey, int threads)
{
  constexpr double step = 0.02; // metres along a section
  const Index sections = std::max<Index>(1, std::llround((storey.ceiling - storey.floor) / section_pitch));
  std::vector<std::vector<Vector3f>> found(sections);
  parallelFor(
      sections, threads,
      [&](Index i) {
        const double z = storey.floor + (i + 0.5) * section_pitch;
        for (const Eigen::Matrix3Xd& line : cutLines(mesh, Vector3d::UnitZ(), z))
          for (Index k = 0; k + 1 < line.cols(); ++k) {
            const Vector3d a = line.col(k), d = line.col(k + 1) - a;
            const int pieces = static_cast<int>(std::ceil(d.norm() / step));
            for (int p = 0; p < pieces; ++p)
              found[i].push_back((a + (p + 0.5) / pieces * d).cast<float>());
          }
      },
      1);
  std::vector<Vector3f> all;
  for (const auto& part : found)
    all.insert(all.end(), part.begin(), part.end());
  return all;
}
} // namespace fresco::plan
