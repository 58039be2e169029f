// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <fresco/core/require.h>
#include <fresco/filters/core/normal_orientation.h>
#include <fresco/filters/core/oriented_normals.h>
#include <fresco/io/packing.h>
#include <fresco/registration/core/scan_registration.h>
#include <optional>
#include <utility>
namespace fresco {
namespace {
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
  for (const Index i : finiteColumns(scan.points))
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
  PointSet own = selectPoints(scan, finiteColumns(scan.points));
  if (own.viewpoints.cols() == 0)
    own.viewpoints = (-own.origin).cast<float>();
  own.normals = orientedNormals(own, threads);
  Eigen::Matrix4d T = T_world_scan;
  T.topRightCorner<3, 1>() -= origin;
  own = transformPoints(own, T);
  own.origin = origin;
  return own;
}

std::vector<Index> placedScans(const std::vector<Pose>& poses)
{
  std::vector<Index> placed;
  const Index count = poses.size();
  for (Index i = 0; i < count; ++i)
    if (poses[i])
      placed.push_back(i);
  return placed;
}

PointSet readSound(const ScanSource& scans, Index scan)
{
  PointSet points = scans.read(scan);
  validatePointSet(points);
  return points;
}

// That of the lowest rank that has one.
std::optional<Eigen::Vector3d> firstOrigin(Exchange& ranks, const std::optional<Eigen::Vector3d>& own)
{
  for (const std::optional<Eigen::Vector3d>& origin : gatherValues(ranks, own))
    if (origin)
      return origin;
  return {};
}
} // namespace

PointSet mergeScans(const std::vector<PointSet>& scans, const std::vector<Pose>& poses, int threads)
{
  return mergeScans(ScanSource(scans.size(), [&](Index i) { return scans[i]; }), poses, threads);
}

PointSet mergeScans(const ScanSource& scans, const std::vector<Pose>& poses, int threads)
{
  ScanSource all = scans;
  all.ranks = nullptr;
  PointSet merged;
  forEachPlacedScan(
      all, poses,
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
  Exchange alone;
  Exchange& ranks = scans.ranks ? *scans.ranks : alone;
  const std::vector<Index> placed = placedScans(poses);
  const Index n = placed.size();
  std::optional<Eigen::Vector3d> origin; // by the first scan that has points
  for (Index begin = 0; begin < n; begin += ranks.size()) {
    const Index own = begin + ranks.rank();
    const PointSet scan = own < n ? readSound(scans, placed[own]) : PointSet();
    if (!origin)
      origin = firstOrigin(ranks, scan.size() > 0 ? std::optional(originFor(scan, *poses[placed[own]])) : std::nullopt);
    if (scan.size() == 0)
      continue;
    if (PointSet in_world = placedScan(scan, *poses[placed[own]], *origin, threads); in_world.size() > 0)
      receive(placed[own], std::move(in_world));
  }
}
} // namespace fresco
