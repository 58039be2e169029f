// SPDX-License-Identifier: BSD-3-Clause
#include "stages/free_space.h"
#include "stages/placed_points.h"
#include "stages/stages.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <fresco/io/pose_file.h>
#include <fresco/search/neighbors.h>
#include <fresco/surface/core/mesh_trimming.h>
#include <fresco/surface/core/seen_surface.h>
#include <fresco/surface/core/volumetric_reconstruction.h>
#include <functional>
namespace fresco::model {
namespace {
/// Octree levels. Fused frames have a point in every cell of their surface, so half as many along a line already tell of
/// invented surface; scans thin out with the distance.
constexpr double most_trim_of_frames = 0.75;

/// 1 where no point of the data is within a cell.
std::vector<char> farFromPoints(const TriangleMesh& mesh, const PlacedPoints& placed, float cell, int threads)
{
  std::vector<char> far(mesh.vertexCount(), 1);
  placed.forEach([&](const PointSet& points) {
    const PointTree tree(points.points, threads);
    const Eigen::Vector3f shift = (mesh.origin - points.origin).cast<float>();
    parallelFor(mesh.vertexCount(), threads, [&](Index v) {
      const Eigen::Vector3f place = mesh.vertices.col(v) + shift;
      far[v] = far[v] && tree.nearest(place, cell).index < 0;
    });
  });
  return far;
}

/// Hands over each scan as it was measured, in the frame of its scanner, which stands at the origin.
void forEachScan(const Job& job, const std::function<void(const Points&, const Eigen::Isometry3d&)>& receive)
{
  const std::vector<Pose> poses = readPoses(job.files.poses);
  for (std::size_t s = 0; s < job.input.scans.size(); ++s)
    if (poses.at(s)) {
      const PointSet scan = readPoints(job.input.scans[s]);
      if (scan.viewpoints.cols() > 1) // of several stations: no one place that the beams come from
        continue;
      Eigen::Vector3f scanner = (-scan.origin).cast<float>();
      if (scan.viewpoints.cols() == 1)
        scanner = scan.viewpoints.col(0);
      const Eigen::Translation3d T_scan_scanner(scan.origin + scanner.cast<double>());
      receive(scan.points.colwise() - scanner, Eigen::Isometry3d(*poses[s]) * T_scan_scanner);
    }
}

/// All scans in the world, each in a window of its own with the place of its scanner as origin.
class Beams : public PointStream {
public:
  explicit Beams(const Job& job) : job_(job) {}
  void read(const std::function<void(const PointSet&)>& receive) const override
  {
    forEachScan(job_, [&](const Points& scan, const Eigen::Isometry3d& T_world_scanner) {
      PointSet beams;
      beams.points = T_world_scanner.linear().cast<float>() * scan;
      beams.viewpoints.setZero(3, 1);
      beams.origin = T_world_scanner.translation();
      receive(beams);
    });
  }

private:
  const Job& job_;
};

void askFrames(const RgbdFolder& rgbd, const std::vector<Pose>& poses, int threads, FreeSpace& space)
{
  constexpr Index at_once = 16; // images, 10 MB of 640 x 480
  std::vector<Index> placed;
  for (std::size_t f = 0; f < rgbd.frames.size(); ++f)
    if (poses.at(f))
      placed.push_back(f);
  const Index count = placed.size();
  std::vector<Image16> images(at_once);
  for (Index begin = 0; begin < count; begin += at_once) {
    const Index end = std::min(count, begin + at_once);
    const auto read = [&](Index i) { images[i] = readDepthUnits(rgbd, placed[begin + i]); };
    parallelFor(end - begin, threads, read, 1);
    for (Index k = begin; k < end; ++k)
      space.ask(images[k - begin], rgbd.camera, Eigen::Isometry3d(*poses[placed[k]]), rgbd.depth_unit);
  }
}

FreeSpace askAllViews(const Points& places, const Job& job, double cell)
{
  const auto& [input, files, options, stages, ranks] = job;
  FreeSpace space(places, cell, options.threads);
  const std::vector<Pose> poses = readPoses(files.poses);
  if (input.rgbd)
    askFrames(*input.rgbd, poses, options.threads, space);
  if (!input.is_cloud)
    forEachScan(
        job, [&](const Points& scan, const Eigen::Isometry3d& T_world_scanner) { space.ask(scan, T_world_scanner); });
  return space;
}

/// 1 for the vertices in places that the sensors saw through and that no point is near to. Poses of depth cameras are
/// not exact: there, one frame in thirty must have seen through.
std::vector<char> inFreeSpace(const TriangleMesh& mesh, const PlacedPoints& placed, const Job& job, double cell)
{
  std::vector<char> removed = farFromPoints(mesh, placed, cell, job.options.threads);
  std::vector<Index> asked;
  for (Index v = 0; v < mesh.vertexCount(); ++v)
    if (removed[v])
      asked.push_back(v);
  const Points places = (mesh.vertices(Eigen::all, asked).colwise() + mesh.origin.cast<float>()).eval();
  const auto& rgbd = job.input.rgbd;
  const int least = rgbd ? std::max<int>(2, rgbd->frames.size() / 30) : 1;
  const std::vector<char> empty = askAllViews(places, job, cell).empty(least);
  for (std::size_t i = 0; i < asked.size(); ++i)
    removed[asked[i]] = empty[i];
  return removed;
}
/// As many as there are stations, if each scan has one of its own.
Index placedScans(const Job& job)
{
  const std::vector<Pose> poses = readPoses(job.files.poses);
  return std::count_if(poses.begin(), poses.end(), [](const Pose& pose) { return pose.has_value(); });
}

/// The part of a mesh that scans saw, cut along its border. Gaps in it stay closed up to four cells as much coarser as
/// `trim_levels` says.
TriangleMesh seenPart(const TriangleMesh& mesh, const Job& job, double cell)
{
  constexpr double patch = 4; // cells a side
  constexpr int rounds = 3;   // smooth the border within the distance between beams
  const double island = patch * cell, gap = island * std::exp2(job.options.trim_levels);
  const Eigen::VectorXf seen = seenSurface(mesh, Beams(job), cell, job.options.threads);
  return trimMesh(mesh, seen, {0.f, gap * gap, island * island, rounds, job.options.threads});
}
} // namespace

Figures makeSurface(const Job& job, const Progress& progress)
{
  const auto& [input, files, options, stages, ranks] = job;
  report(progress, "read", 0.0);
  const PlacedPoints placed(files.points);
  VolumetricOptions volumetric = stages.reconstruction;
  if (volumetric.depth == 0) {
    volumetric.depth = VolumetricOptions{}.depth;
    volumetric.cell_size = finestCell(job);
  }
  volumetric.trim_levels = input.rgbd ? std::min(options.trim_levels, most_trim_of_frames) : options.trim_levels;
  bool has_beams = false;
  if (!input.scans.empty() && !input.is_cloud) {
    volumetric.free_space = std::make_shared<FreeSpaceMap>(Beams(job));
    has_beams = volumetric.free_space->stations() == placedScans(job);
  }
  if (has_beams)
    volumetric.trim_levels = 0; // it is cut where nobody saw it
  VolumetricResult result = reconstructVolumetric(placed.stream(), volumetric, subProgress(progress, 0.0, 0.7));
  Index carved = 0;
  if (options.trim_levels > 0) {
    if (has_beams)
      result.mesh = seenPart(result.mesh, job, result.cell_size);
    report(progress, "free space", 0.7);
    std::vector<char> removed = inFreeSpace(result.mesh, placed, job, result.cell_size);
    carved = std::count(removed.begin(), removed.end(), 1);
    result.mesh = withoutVertices(result.mesh, std::move(removed));
  }
  if (result.mesh.faceCount() == 0)
    throw std::runtime_error(files.points + ": no surface could be made of the points");
  writeMesh(files.surface, result.mesh);
  const MeshTopology topology = meshTopology(result.mesh);
  return {{"vertices", result.mesh.vertexCount()},
          {"faces", result.mesh.faceCount()},
          {"octree_depth", result.depth},
          {"cell", result.cell_size},
          {"trim_depth", result.trim_depth},
          {"vertices_in_free_space", carved},
          {"components", topology.components},
          {"boundary_edges", topology.boundary_edges},
          {"non_manifold_edges", topology.nonmanifold_edges},
          {"watertight", topology.watertight}};
}
} // namespace fresco::model
