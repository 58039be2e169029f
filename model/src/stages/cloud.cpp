// SPDX-License-Identifier: BSD-3-Clause
#include "stages/cloud.h"
#include "input/standpoint.h"
#include "stages/placed_points.h"
#include "stages/stages.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/point_table.h>
#include <fresco/core/require.h>
#include <fresco/core/statistics.h>
#include <fresco/filters/core/normal_orientation.h>
#include <fresco/filters/core/outliers.h>
#include <fresco/io/cloud_file.h>
#include <fresco/io/file.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <fresco/io/pose_file.h>
#include <fresco/search/neighbors.h>
#include <iomanip>
namespace fresco::model {
namespace {
constexpr double least_consistent = 0.97; ///< of pairs of neighbours; beside edges and in noise some disagree rightly

/// Every n-th of `count`, about `most` of them.
Index strideFor(Index count, Index most) { return std::max<Index>(1, count / most); }

/// The points of structure from motion that several photographs agree on, each seen from the first of these.
PointSet cloudOfPhotographs(const Job& job)
{
  constexpr std::size_t fewest_views = 3;
  const CameraSet cameras = placedCameras(job);
  const SparsePoints found = foundPoints(job);
  std::vector<Eigen::Vector3f> points, seen_from;
  PointSet cloud;
  for (const SparsePoint& point : found)
    if (point.track.size() >= fewest_views) {
      points.push_back(point.position.cast<float>());
      seen_from.push_back(cameras.views.at(point.track[0].view).center().cast<float>());
    }
  if (points.size() < 100)
    throw std::runtime_error(concat(job.input.folder, ": only ", points.size(),
                                    " points that three photographs agree on: more of "
                                    "them, with more overlap, or scans are wanted"));
  cloud.points = Eigen::Map<const Points>(points[0].data(), 3, points.size());
  cloud.viewpoints = Eigen::Map<const Points>(seen_from[0].data(), 3, points.size());
  return cloud;
}

/// Points spread evenly over the faces of a file's mesh, with their normals: a triangle's share by its area, at places of the
/// sequence of Halton 1960.
PointSet pointsOnFaces(const std::string& file)
{
  const TriangleMesh mesh = readMesh(file);
  constexpr double fewest = 3e5, most = 4e6, a_vertex = 10;
  const double area = surfaceArea(mesh), count = std::clamp(a_vertex * double(mesh.vertexCount()), fewest, most);
  const Points face_normals = faceNormals(mesh);
  std::vector<Eigen::Vector3f> points, normals;
  const auto halton = [](std::uint64_t i, int base) {
    double value = 0;
    for (double digit = 1.0 / base; i > 0; i /= base, digit /= base)
      value += digit * double(i % base);
    return float(value);
  };
  double owed = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const Eigen::Vector3f a = mesh.vertices.col(mesh.faces(0, f)), ab = mesh.vertices.col(mesh.faces(1, f)) - a,
                          ac = mesh.vertices.col(mesh.faces(2, f)) - a;
    owed += 0.5 * ab.cross(ac).norm() / area * count;
    for (; owed >= 1; --owed) {
      float u = halton(points.size() + 1, 2), v = halton(points.size() + 1, 3);
      if (u + v > 1)
        u = 1 - u, v = 1 - v;
      points.emplace_back(a + u * ab + v * ac);
      normals.emplace_back(face_normals.col(f));
    }
  }
  if (points.empty())
    throw std::runtime_error(file + ": a mesh without area");
  PointSet set;
  set.origin = mesh.origin;
  set.points = Eigen::Map<const Points>(points[0].data(), 3, points.size());
  set.normals = Eigen::Map<const Points>(normals[0].data(), 3, normals.size());
  return set;
}

/// A column of a cloud; empty where it has none of these names.
std::vector<double> columnOf(const pcl::PCLPointCloud2& cloud, std::initializer_list<const char*> names)
{
  std::vector<double> values;
  for (const char* name : names)
    for (const pcl::PCLPointField& field : cloud.fields)
      if (values.empty() && field.name == name &&
          (field.datatype == pcl::PCLPointField::FLOAT64 || field.datatype == pcl::PCLPointField::FLOAT32))
        for (std::size_t at = field.offset; at < cloud.data.size(); at += cloud.point_step)
          values.push_back(field.datatype == pcl::PCLPointField::FLOAT64 ? core::loadScalar<double>(&cloud.data[at])
                                                                         : core::loadScalar<float>(&cloud.data[at]));
  return values;
}

/// Points of a file. Where these and the trajectory bear times of one clock, each with the place that it was seen from then.
PointSet readTimedPoints(const ScanPath& scan, const ModelInput& input, std::vector<std::string>& warnings)
{
  const std::vector<double>& times = input.sensor_times;
  if (times.size() < 2)
    return readPoints(scan);
  const CloudFile file = readCloud(scan);
  PointSet set = toPointSet(file);
  const std::vector<double> seen = columnOf(file.cloud, {"gps_time", "time", "timestamp", "t"});
  Points places(3, seen.size());
  Index within = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const std::size_t next = std::clamp<std::size_t>(
        std::upper_bound(times.begin(), times.end(), seen[i]) - times.begin(), 1, times.size() - 1);
    const double share =
        std::clamp((seen[i] - times[next - 1]) / std::max(times[next] - times[next - 1], 1e-9), 0.0, 1.0);
    within += seen[i] >= times.front() && seen[i] <= times.back();
    places.col(i) =
        ((1 - share) * input.sensor_path[next - 1] + share * input.sensor_path[next] - set.origin).cast<float>();
  }
  if (2 * within > Index(seen.size()) && Index(seen.size()) == set.size())
    set.viewpoints = places;
  else if (!seen.empty())
    warnings.push_back(scan.name() + ": its times and those of trajectory.txt do not meet: is it the same clock?");
  return set;
}

/// Points of a file of the cloud, or on the faces of its surface; none of one of several that is damaged.
PointSet readPart(const ScanPath& scan, const ModelInput& input, std::vector<std::string>& warnings)
try {
  return holdsFaces(scan.file) ? pointsOnFaces(scan.file) : readTimedPoints(scan, input, warnings);
} catch (const std::runtime_error& error) {
  if (input.scans.size() == 1)
    throw;
  warnings.push_back(concat("left out: ", error.what()));
  return {};
}

/// All files of the cloud in the frame of the world, near an origin that is the first point's: large coordinates stay exact.
PointSet readCloud(const Job& job, std::vector<std::string>& warnings, const Progress& progress)
{
  const ModelInput& input = job.input;
  if (input.scans.empty())
    return cloudOfPhotographs(job);
  PointSet cloud;
  for (std::size_t s = 0; s < input.scans.size(); ++s) {
    report(progress, concat("file ", s + 1, " of ", input.scans.size()), 0.3 * double(s) / double(input.scans.size()));
    PointSet part = readPart(input.scans[s], input, warnings);
    if (part.size() == 0 || !input.poses.at(s))
      continue;
    if (!tellsViewpoint(part))
      part.viewpoints.resize(3, 0);
    Eigen::Matrix4d T = *input.poses[s];
    if (!T.isIdentity()) {
      const Eigen::Vector3d origin = cloud.size() > 0 ? cloud.origin : T.topRightCorner<3, 1>();
      T.topRightCorner<3, 1>() -= origin;
      part = transformPoints(part, T);
      part.origin = origin;
    }
    appendPoints(cloud, part);
  }
  if (cloud.size() == 0)
    throw std::runtime_error(input.folder + ": no points" + (warnings.empty() ? "" : ", " + warnings[0]));
  return cloud;
}

/// Finest cell that the points sustain, without more vertices than are of use; of few points a rough surface.
double cellOf(double spacing, const Points& points)
{
  constexpr double spacings = 2, most_vertices = 3e6, fewest_across = 32;
  const double sustained = std::max(spacings * spacing, spacing * std::sqrt(double(points.cols()) / most_vertices));
  const double extent = (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).maxCoeff();
  return std::min(sustained, extent / fewest_across);
}
} // namespace

double consistency(const Points& points, const Points& normals, int threads)
{
  constexpr Index asked = 20000;
  constexpr int neighbors = 9;
  constexpr double steepest = 0.35; // sine of the angle by which the median neighbour may lie off the plane: 20 degrees
  const PointTree tree(points, threads);
  std::vector<float> slopes;
  double same = 0, all = 0;
  std::vector<Neighbor> near;
  for (Index i = 0; i < points.cols(); i += strideFor(points.cols(), asked)) {
    const Eigen::Vector3f normal = normals.col(i);
    if (!points.col(i).allFinite() || !(std::abs(normal.norm() - 1) < 0.05f)) {
      all += neighbors - 1;
      continue;
    }
    tree.nearest(points.col(i), neighbors, near);
    for (const Neighbor& other : near) {
      if (other.index == i)
        continue;
      const Eigen::Vector3f between = (points.col(other.index) - points.col(i)).stableNormalized(),
                            next = normals.col(other.index);
      slopes.push_back(std::abs(between.dot(normal)));
      ++all;
      same += normal.dot(next - 2 * between.dot(next) * between) > 0;
    }
  }
  return slopes.empty() || median(slopes) > steepest ? 0 : same / all;
}

double pointSpacing(const Points& points, int threads)
{
  constexpr Index asked = 20000;
  constexpr int neighbors = 9;
  const PointTree tree(points, threads);
  std::vector<double> areas;
  std::vector<Neighbor> near;
  for (Index i = 0; i < points.cols(); i += strideFor(points.cols(), asked)) {
    tree.nearest(points.col(i), neighbors, near);
    if (int(near.size()) == neighbors)
      areas.push_back(M_PI * near.back().squared_distance / (neighbors - 1));
  }
  if (areas.empty())
    throw std::runtime_error("fewer than 10 points");
  return std::sqrt(median(areas));
}

Orientation orientCloud(PointSet& set, const FreeSideHints& hints, const NormalOptions& options)
{
  if (set.viewpoints.cols() == 0 && set.hasNormals() &&
      consistency(set.points, set.normals, options.threads) >= least_consistent)
    return Orientation::file;
  const NormalField field = estimateNormals(set, options);
  set.normals = field.normals;
  set.confidences = field.confidences;
  if (set.viewpoints.cols() > 0)
    return Orientation::viewpoints;
  orientToFreeSide(set.points, hints, set.normals, options.threads);
  return Orientation::cloud;
}

Figures pointsFromCloud(const Job& job, const Progress& progress)
{
  constexpr double within = 2; // metres: in less than that nobody stood to look around
  const auto& [input, files, options, stages, ranks] = job;
  std::vector<std::string> warnings;
  PointSet cloud = readCloud(job, warnings, progress);
  const Index raw = cloud.size();
  const bool has_normals = cloud.hasNormals();
  report(progress, "outliers", 0.3);
  cloud = selectPoints(cloud, withoutOutliers(cloud.points, stages.outliers));
  if (constexpr Index fewest = 100; cloud.size() < fewest)
    throw std::runtime_error(concat(input.scans.empty() ? input.folder : input.scans[0].file, ": only ", cloud.size(),
                                    " points but for outliers: no surface can be made of them"));
  report(progress, "normals", 0.4);
  FreeSideHints hints;
  hints.sensors.resize(3, input.sensor_path.size());
  for (std::size_t k = 0; k < input.sensor_path.size(); ++k)
    hints.sensors.col(k) = (input.sensor_path[k] - cloud.origin).cast<float>();
  const Eigen::Vector3f extent = cloud.points.rowwise().maxCoeff() - cloud.points.rowwise().minCoeff();
  hints.outside = extent.norm() < within;
  const Orientation found = orientCloud(cloud, hints, stages.normals);
  const double spacing = pointSpacing(cloud.points, options.threads);
  cloud = smoothed(cloud, job, subProgress(progress, 0.7, 1.0));
  const PlacedPoints placed(files.points);
  placed.clear();
  placed.write(0, cloud);
  writePoses(files.poses,
             input.poses.empty() ? std::vector<Pose>{Eigen::Matrix4d(Eigen::Matrix4d::Identity())} : input.poses);
  if (constexpr double dense = 100; extent.maxCoeff() < dense * spacing) // points across, to show what stands in a room
    warnings.push_back(concat(std::setprecision(2), "sparse: ", cloud.size(), " points, about ", spacing,
                              " apart in a cloud of ", extent.maxCoeff(),
                              ": between them the surface is a guess, off by up to twice as much"));
  writeFile(files.cell, concat(options.cell > 0 ? options.cell : cellOf(spacing, cloud.points), "\n"));
  Figures figures{
      {"registration", "none: one cloud"}, {"raw_points", raw}, {"points", cloud.size()}, {"point_spacing", spacing}};
  if (found == Orientation::cloud && has_normals)
    warnings.emplace_back(
        "the normals of the file are not used: neighbours point to different sides, or do not stand on the surface");
  if (!warnings.empty())
    figures["warnings"] = warnings;
  figures["normals"] = found == Orientation::file         ? "those of the file"
                       : found == Orientation::viewpoints ? "to where each point was seen from"
                       : !input.sensor_path.empty()       ? "to the places of the sensor in sight"
                       : hints.outside                    ? "outwards: smaller than a room"
                                                          : "to the free side within";
  return figures;
}
} // namespace fresco::model
