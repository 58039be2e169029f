// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <fresco/core/require.h>
#include <fresco/filters/core/normal_orientation.h>
#include <fresco/filters/core/oriented_normals.h>
#include <fresco/registration/core/scan_registration.h>
#include <optional>
#include <utility>
namespace fresco {
namespace {
std::vector<Index> finiteColumns(const PointSet& scan)
{
  std::vector<Index> finite;
  for (Index i = 0; i < scan.size(); ++i)
    if (scan.points.col(i).allFinite())
      finite.push_back(i);
  return finite;
}

// Those of the scan where it has them, else estimated; towards the viewpoints.
Points orientedNormals(const PointSet& scan, int threads)
{
  Points normals = scan.normals;
  if (!scan.hasNormals() || !scan.normals.allFinite()) {
    NormalOptions options;
    options.threads = threads;
    normals = estimateNormals(scan, options).normals;
  }
  orientToViewpoints(scan.points, scan.viewpoints, normals, threads);
  return normals;
}

// Centre of the finite points' bounds in the world, in whole units, where it is far from the world's origin; else zero.
Eigen::Vector3d originFor(const PointSet& scan, const Eigen::Matrix4d& T_world_scan)
{
  constexpr double large_coordinate = 1000.0; // beyond, a float resolves less than a tenth of a millimetre in metres
  Eigen::AlignedBox3d bounds;
  for (const Index i : finiteColumns(scan))
    bounds.extend(scan.points.col(i).cast<double>());
  if (bounds.isEmpty())
    return Eigen::Vector3d::Zero();
  const Eigen::Vector3d center =
      T_world_scan.topLeftCorner<3, 3>() * (scan.origin + bounds.center()) + T_world_scan.topRightCorner<3, 1>();
  return center.norm() > large_coordinate ? Eigen::Vector3d(center.array().round()) : Eigen::Vector3d::Zero();
}

// One scan in the world less `origin`, with normals and viewpoints.
PointSet placedScan(const PointSet& scan, const Eigen::Matrix4d& T_world_scan, const Eigen::Vector3d& origin,
                    int threads)
{
  PointSet own = selectPoints(scan, finiteColumns(scan));
  if (own.viewpoints.cols() == 0)
    own.viewpoints = (-own.origin).cast<float>();
  own.normals = orientedNormals(own, threads);
  Eigen::Matrix4d T = T_world_scan;
  T.topRightCorner<3, 1>() -= origin;
  own = transformPoints(own, T);
  own.origin = origin;
  return own;
}
} // namespace

PointSet mergeScans(const std::vector<PointSet>& scans, const std::vector<Pose>& poses, int threads)
{
  return mergeScans(ScanSource(scans.size(), [&](Index i) { return scans[i]; }), poses, threads);
}

PointSet mergeScans(const ScanSource& scans, const std::vector<Pose>& poses, int threads)
{
  PointSet merged;
  forEachPlacedScan(
      scans, poses,
      [&](Index, PointSet placed) {
        if (merged.size() == 0)
          merged = std::move(placed);
        else
          appendPoints(merged, placed);
      },
      threads);
  if (merged.viewpoints.cols() == 1)
    merged.viewpoints = Points(merged.viewpoints.replicate(1, merged.size()));
  return merged;
}

void forEachPlacedScan(const ScanSource& scans, const std::vector<Pose>& poses,
                       const std::function<void(Index, PointSet)>& receive, int threads)
{
  const Index count = poses.size();
  require(scans.count == count, "merge: ", scans.count, " scans, ", poses.size(), " poses");
  std::optional<Eigen::Vector3d> origin;
  for (Index i = 0; i < count; ++i) {
    if (!poses[i])
      continue;
    const PointSet scan = scans.read(i);
    validatePointSet(scan);
    if (scan.size() == 0)
      continue;
    if (!origin)
      origin = originFor(scan, *poses[i]);
    if (PointSet placed = placedScan(scan, *poses[i], *origin, threads); placed.size() > 0)
      receive(i, std::move(placed));
  }
}
} // namespace fresco
