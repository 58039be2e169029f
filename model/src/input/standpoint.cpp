// SPDX-License-Identifier: BSD-3-Clause
#include "input/standpoint.h"
#include <algorithm>
#include <cmath>
#include <fresco/io/file.h>
#include <fresco/search/neighbors.h>
#include <fstream>
namespace fresco::model {
namespace {
constexpr Index most_points = Index{1} << 22; ///< that are looked at
constexpr Index kept_points = 100000; ///< a beam each 0.6 degrees: close enough to have a neighbour on the same surface

/// Every n-th point, finite ones. @param set gets what else the first window tells
Points sampleOf(const ScanPath& scan, PointSet& first)
{
  constexpr Index window = 1 << 16;
  std::vector<Eigen::Vector3f> points;
  Index read = 0, stride = 1;
  streamPoints(scan, window, [&](const PointSet& set) {
    if (read == 0)
      first = selectPoints(set, {});
    first.viewpoints = set.viewpoints;
    const Eigen::Vector3f shift = (set.origin).cast<float>();
    for (Index i = (stride - read % stride) % stride; i < set.size(); i += stride)
      if (set.points.col(i).allFinite())
        points.emplace_back(set.points.col(i) + shift);
    read += set.size();
    while (Index(points.size()) > 2 * kept_points) { // keep every other one
      for (std::size_t i = 0; 2 * i < points.size(); ++i)
        points[i] = points[2 * i];
      points.resize((points.size() + 1) / 2);
      stride *= 2;
    }
    return read < most_points;
  });
  Points all(3, points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    all.col(i) = points[i];
  return all;
}
} // namespace

Points samplePoints(const ScanPath& scan)
{
  PointSet first;
  return sampleOf(scan, first);
}

double hiddenShare(const Points& points)
{
  constexpr float other_range =
      0.1f; // of the range: no surface but one seen at a grazing angle falls off so fast between beams
  const Eigen::VectorXf ranges = points.colwise().norm();
  const Points directions = points.array().rowwise() / ranges.transpose().array().max(1e-30f);
  const PointTree tree(directions, 0);
  const Index step = std::max<Index>(1, points.cols() / 4000);
  Index asked = 0, hidden = 0;
  std::vector<Neighbor> near;
  for (Index i = 0; i < points.cols(); i += step) {
    tree.nearest(directions.col(i), 2, near);
    const Index j = near[0].index == i ? near.back().index : near[0].index;
    ++asked;
    hidden += std::abs(ranges[i] - ranges[j]) > other_range * std::max(ranges[i], ranges[j]);
  }
  return double(hidden) / asked;
}

bool holdsFaces(const std::string& file)
{
  const std::string kind = extension(file);
  std::string head(4096, '\0');
  if (kind == ".ply")
    std::ifstream(file, std::ios::binary).read(head.data(), std::streamsize(head.size()));
  const std::size_t at = head.find("\nelement face ");
  return kind == ".obj" || kind == ".stl" || (at != std::string::npos && head[at + 14] >= '1' && head[at + 14] <= '9');
}

bool tellsViewpoint(const PointSet& set)
{
  return set.viewpoints.cols() > 1 ||
         (set.viewpoints.cols() == 1 && !(set.origin + set.viewpoints.col(0).cast<double>()).isZero());
}

Standing standpointOf(const ScanPath& scan)
{
  if (holdsFaces(scan.file))
    return {Standpoint::many, {}};
  constexpr double most_hidden = 0.05; // 0.01 to 0.04 of scans of rooms, 0.08 to 0.3 of merged ones: docs/inputs.md
  if (holdsScans(scan.file)) {
    const std::vector<ScanInfo> infos = readScanInfos(scan);
    const ScanInfo& info = infos.at(std::max<Index>(scan.scan, 0));
    const bool placed = info.has_pose && !info.T_file_scan.matrix().isIdentity(); // else maybe all scans as one
    if (placed || info.sensor || infos.size() > 1) // files of several scans keep them apart
      return {Standpoint::origin, {}};
  }
  PointSet first;
  const Points points = sampleOf(scan, first);
  if (tellsViewpoint(first))
    return {first.viewpoints.cols() == 1 ? Standpoint::origin : Standpoint::many, {}};
  if (points.cols() == 0)
    throw std::runtime_error(scan.name() + ": no points in it");
  if (points.cols() < 2)
    return {};
  const Eigen::AlignedBox3f box(points.rowwise().minCoeff(), points.rowwise().maxCoeff());
  constexpr float nearest = 0.3f; // metres; what lies around the origin within that was turned before a scanner
  if (box.exteriorDistance(Eigen::Vector3f::Zero().eval()) > box.diagonal().norm() ||
      points.colwise().norm().maxCoeff() < nearest)
    return {Standpoint::many, box};
  return {hiddenShare(points) < most_hidden ? Standpoint::origin : Standpoint::unknown, box};
}
} // namespace fresco::model
