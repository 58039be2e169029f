// SPDX-License-Identifier: BSD-3-Clause
#include <fresco/core/require.h>
#include <fresco/filters/core/normal_orientation.h>
#include <fresco/filters/core/oriented_normals.h>
#include <fresco/registration/core/scan_registration.h>
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

// One scan in the world less `origin`, with normals and a viewpoint per point.
PointSet placedScan(const PointSet& scan, const Eigen::Matrix4d& T_world_scan, const Eigen::Vector3d& origin,
                    int threads)
{
  PointSet own = selectPoints(scan, finiteColumns(scan));
  if (own.viewpoints.cols() == 0)
    own.viewpoints = (-own.origin).cast<float>();
  if (own.viewpoints.cols() == 1)
    own.viewpoints = Points(own.viewpoints.replicate(1, own.size()));
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
  constexpr double large_coordinate = 1000.0; // beyond, a float resolves less than a tenth of a millimetre in metres
  const Index count = poses.size();
  require(scans.count == count, "merge: ", scans.count, " scans, ", poses.size(), " poses");
  PointSet merged;
  for (Index i = 0; i < count; ++i) {
    if (!poses[i])
      continue;
    const PointSet scan = scans.read(i);
    validatePointSet(scan);
    if (scan.size() == 0)
      continue;
    if (merged.size() == 0) {
      const Eigen::Vector3d place = poses[i]->topRightCorner<3, 1>();
      merged.origin =
          place.norm() > large_coordinate ? Eigen::Vector3d(place.array().round()) : Eigen::Vector3d::Zero();
    }
    appendPoints(merged, placedScan(scan, *poses[i], merged.origin, threads));
  }
  return merged;
}
} // namespace fresco
