// SPDX-License-Identifier: BSD-3-Clause
#include "scanned_room.h"
#include "support/tool.h"
#include <Eigen/Eigenvalues>
#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <fresco/common/parallel.h>
#include <fresco/filters/core/bilateral_normals.h>
#include <fresco/filters/core/neighbors.h>
#include <fresco/filters/core/oriented_normals.h>
#include <map>
#include <pcl/features/normal_3d_omp.h>
#include <pcl/point_types.h>
/// Normals of laser scans of a generated room against the true ones: pcl::NormalEstimationOMP, estimateNormals() and
/// smoothNormals().
using namespace fresco;
using Eigen::Vector3f;

namespace {
struct MeasureOptions {
  std::string scene = "conference_room";
  int stations = 2, points = 1000000, k = 16;
  bool oracle = false, merged = false;
  float edge = 0.02f;    ///< metres to a crease: "beside an edge"
  float plane = 0.1f;    ///< metres without any bend around: "on planes"
  float bend = 1.f;      ///< degrees between faces of one plane at most
  float crease = 30.f;   ///< degrees between the faces of an edge
  float spread = 0.002f; ///< metres between the places that stand for a crease
};

struct Sample {
  Points points, truth;    ///< sensor frame
  Points exact;            ///< where the beams meet the faces, without noise
  std::vector<char> place; ///< 0 = beside an edge, 1 = on a plane, 2 = elsewhere: bent surfaces, near edges
  Points viewpoints = Vector3f::Zero(); ///< 3x1 or 3xN

  Vector3f ray(Index i) const { return points.col(i) - viewpoints.col(viewpoints.cols() == 1 ? 0 : i); }
};

Vector3f faceNormal(const TriangleMesh& mesh, Index face)
{
  const Eigen::Vector3i v = mesh.faces.col(face);
  const Vector3f a = mesh.vertices.col(v[0]);
  return (Vector3f(mesh.vertices.col(v[1])) - a).cross(Vector3f(mesh.vertices.col(v[2])) - a).normalized();
}

/// Places along the edges where faces meet at more than `degrees`, or that do not belong to two faces.
Points creasePlaces(const TriangleMesh& mesh, float degrees, float spread)
{
  std::map<std::array<float, 3>, int> first;
  std::map<std::pair<int, int>, std::vector<Index>> edges;
  const auto welded = [&](int v) {
    return first.emplace(std::array{mesh.vertices(0, v), mesh.vertices(1, v), mesh.vertices(2, v)}, v).first->second;
  };
  for (Index f = 0; f < mesh.faceCount(); ++f)
    for (int k = 0; k < 3; ++k) {
      const int a = welded(mesh.faces(k, f)), b = welded(mesh.faces((k + 1) % 3, f));
      if (a != b)
        edges[{std::min(a, b), std::max(a, b)}].push_back(f);
    }
  const float flat = std::cos(degrees * 0.017453293f);
  std::vector<Vector3f> places;
  for (const auto& [ends, faces] : edges) {
    if (faces.size() == 2 && faceNormal(mesh, faces[0]).dot(faceNormal(mesh, faces[1])) > flat)
      continue;
    const Vector3f a = mesh.vertices.col(ends.first), way = Vector3f(mesh.vertices.col(ends.second)) - a;
    const int steps = std::max(1, static_cast<int>(way.norm() / spread));
    for (int s = 0; s <= steps; ++s)
      places.emplace_back(a + way * (static_cast<float>(s) / static_cast<float>(steps)));
  }
  Points all(3, static_cast<Index>(places.size()));
  for (std::size_t i = 0; i < places.size(); ++i)
    all.col(static_cast<Index>(i)) = places[i];
  return all;
}

struct Creases {
  PointTree sharp, bends;
};

/// The points of a scan; no true normal where the beam met several surfaces.
Sample takeSample(const LitScene& lit, const Creases& creases, const Vector3f& station, const LaserOptions& laser,
                  const MeasureOptions& options)
{
  Eigen::Matrix4d pose = Eigen::Matrix4d::Identity();
  pose.topRightCorner<3, 1>() = station.cast<double>() + lit.scene.mesh.origin;
  const LaserScan scan = scanScene(lit, pose, laser, 0);
  const Index n = scan.points.size();
  Sample sample;
  sample.points = scan.points.points;
  sample.truth.resize(3, n);
  sample.exact.resize(3, n);
  sample.place.resize(static_cast<std::size_t>(n));
  for (Index i = 0; i < n; ++i) {
    const Vector3f normal = faceNormal(lit.scene.mesh, scan.faces[static_cast<std::size_t>(i)]);
    sample.truth.col(i) = scan.mixed[static_cast<std::size_t>(i)] ? Vector3f::Constant(NAN) : normal;
    const Index corner = lit.scene.mesh.faces(0, scan.faces[static_cast<std::size_t>(i)]);
    const Vector3f beam = sample.points.col(i), on_face = Vector3f(lit.scene.mesh.vertices.col(corner)) - station;
    sample.exact.col(i) = beam * (normal.dot(on_face) / normal.dot(beam));
    const Vector3f at = beam + station;
    sample.place[static_cast<std::size_t>(i)] = creases.sharp.nearest(at, options.edge).index >= 0   ? 0
                                                : creases.bends.nearest(at, options.plane).index < 0 ? 1
                                                                                                     : 2;
  }
  return sample;
}

/// All scans as one, in the frame of the room.
Sample merge(const std::vector<Sample>& scans, const Points& stations)
{
  Index n = 0, at = 0;
  for (const Sample& scan : scans)
    n += scan.points.cols();
  Sample all;
  for (Points* values : {&all.points, &all.truth, &all.exact, &all.viewpoints})
    values->resize(3, n);
  for (std::size_t s = 0; s < scans.size(); ++s) {
    const Index count = scans[s].points.cols();
    const Vector3f station = stations.col(static_cast<Index>(s));
    all.points.middleCols(at, count) = scans[s].points.colwise() + station;
    all.exact.middleCols(at, count) = scans[s].exact.colwise() + station;
    all.truth.middleCols(at, count) = scans[s].truth;
    all.viewpoints.middleCols(at, count).colwise() = station;
    all.place.insert(all.place.end(), scans[s].place.begin(), scans[s].place.end());
    at += count;
  }
  return all;
}

struct Errors {
  double sum[3] = {0, 0, 0}, above_20[3] = {0, 0, 0}, seconds = 0, cpu_seconds = 0;
  Index count[3] = {0, 0, 0};
  void add(const Sample& sample, const Points& normals)
  {
    for (Index i = 0; i < normals.cols(); ++i) {
      if (!sample.truth.col(i).allFinite())
        continue;
      const float cosine = sample.truth.col(i).dot(normals.col(i));
      const double angle = std::isfinite(cosine) ? std::acos(std::clamp(cosine, -1.f, 1.f)) * 57.29578 : 180.0;
      const int where = sample.place[static_cast<std::size_t>(i)];
      sum[where] += angle, above_20[where] += angle > 20, ++count[where];
    }
  }
  void print(const char* name) const
  {
    std::printf("| %-32s |", name);
    for (int where = 0; where < 3; ++where)
      std::printf(" %5.2f deg, %4.1f %% |", sum[where] / static_cast<double>(count[where]),
                  100 * above_20[where] / static_cast<double>(count[where]));
    std::printf(" %6.2f | %6.2f |\n", seconds, cpu_seconds);
    std::fflush(stdout);
  }
};

template <typename Work>
Points timed(Errors& errors, const Work& work)
{
  const auto cpu = std::clock();
  const auto wall = std::chrono::steady_clock::now();
  Points result = work();
  errors.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
  errors.cpu_seconds += static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
  return result;
}

/// Each turned to the station that saw it.
Points pclNormals(const Sample& sample, int k, int threads)
{
  const Points& points = sample.points;
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (Index i = 0; i < points.cols(); ++i)
    cloud->push_back({points(0, i), points(1, i), points(2, i)});
  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation(static_cast<unsigned>(threads));
  estimation.setInputCloud(cloud);
  estimation.setKSearch(k);
  estimation.setViewPoint(0, 0, 0);
  pcl::PointCloud<pcl::Normal> output;
  estimation.compute(output);
  Points normals(3, points.cols());
  for (Index i = 0; i < points.cols(); ++i) {
    const Vector3f normal = output[static_cast<std::size_t>(i)].getNormalVector3fMap();
    normals.col(i) = normal.dot(sample.ray(i)) > 0 ? Vector3f(-normal) : normal;
  }
  return normals;
}

/// Least squares planes through those of the k nearest that lie on the same true surface: no choice of neighbours among
/// them can tell the sides of an edge apart better.
Points oracleNormals(const Sample& sample, const PointTree& tree, int k, int threads)
{
  const NeighborLists lists = nearestLists(tree, k, threads);
  Points normals = Points::Constant(3, sample.points.cols(), NAN);
  parallelFor(lists.size(), threads, [&](Index i) {
    const int column = tree.columns()[static_cast<std::size_t>(i)];
    const Vector3f truth = sample.truth.col(column), here = sample.points.col(column), ray = sample.ray(column);
    Eigen::Matrix3f A = Eigen::Matrix3f::Zero();
    Vector3f sum = Vector3f::Zero();
    int count = 0;
    for (const int* j = lists.first(i); j != lists.last(i); ++j) {
      const int other = tree.columns()[static_cast<std::size_t>(*j)];
      const Vector3f way = sample.exact.col(other) - sample.exact.col(column);
      if (!(truth.dot(sample.truth.col(other)) > 0.985f) || std::abs(truth.dot(way)) > 0.001f + 0.1f * way.norm())
        continue;
      const Vector3f offset = sample.points.col(other) - here;
      A += offset * offset.transpose();
      sum += offset;
      ++count;
    }
    const auto n = static_cast<float>(std::max(1, count));
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> eigen(A / n - sum / n * (sum / n).transpose());
    const Vector3f normal = count < 3 ? Vector3f(-ray.normalized()) : Vector3f(eigen.eigenvectors().col(0));
    normals.col(column) = normal.dot(ray) > 0 ? Vector3f(-normal) : normal;
  });
  return normals;
}

void printOracles(const std::vector<Sample>& samples, int threads)
{
  for (const int k : {16, 32, 64, 128}) {
    Errors errors;
    for (const Sample& sample : samples) {
      const PointTree tree(sample.points, threads);
      errors.add(sample, timed(errors, [&] { return oracleNormals(sample, tree, k, threads); }));
    }
    errors.print(("neighbours sorted by truth, k = " + std::to_string(k)).c_str());
  }
}

void compareAtNoise(const std::vector<Sample>& samples, int k, int threads)
{
  Errors pcl_errors, ours, smooth[3];
  const int rounds[3] = {1, 3, 5};
  for (const Sample& sample : samples) {
    pcl_errors.add(sample, timed(pcl_errors, [&] { return pclNormals(sample, k, threads); }));
    NormalOptions options;
    options.k = k;
    options.threads = threads;
    PointSet set;
    set.points = sample.points;
    set.viewpoints = sample.viewpoints;
    const Points normals = timed(ours, [&] { return estimateNormals(set, options).normals; });
    ours.add(sample, normals);
    for (int r = 0; r < 3; ++r) {
      BilateralOptions smoothing;
      smoothing.rounds = rounds[r];
      smoothing.threads = threads;
      smooth[r].add(sample, timed(smooth[r], [&] { return smoothNormals(set.points, normals, smoothing).normals; }));
    }
  }
  pcl_errors.print("pcl::NormalEstimationOMP");
  ours.print("estimateNormals");
  smooth[0].print("and 1 round of smoothNormals");
  smooth[1].print("and 3 rounds");
  smooth[2].print("and 5 rounds");
}
} // namespace

int main(int argc, char** argv)
{
  return runTool("fresco_benchmark_normals", [&] {
    MeasureOptions options;
    CommonOptions common;
    Args args("fresco_benchmark_normals [options]",
              "Angles between estimated and true normals of generated laser scans, beside edges and elsewhere.");
    args.option("scene", options.scene, "conference_room, apartment or a mesh file");
    args.flag("oracle", options.oracle, "also plane fits to those of k neighbours that truly lie on one surface");
    args.flag("merged", options.merged, "all stations in one cloud; else each station for itself");
    args.option("stations", options.stations, "laser stations");
    args.option("points", options.points, "laser points per station, about");
    args.option("k", options.k, "neighbours");
    args.option("edge", options.edge, "metres to a crease that count as beside an edge");
    common.declare(args);
    args.parse(argc, argv, 0);
    const ScannedRoom room(options.scene, options.stations, common.threads);
    const Creases creases{PointTree(creasePlaces(room.scene.mesh, options.crease, options.spread), common.threads),
                          PointTree(creasePlaces(room.scene.mesh, options.bend, options.plane / 5), common.threads)};
    for (const float noise : {0.002f, 0.005f}) {
      LaserOptions laser;
      laser.points = options.points;
      laser.noise = noise;
      std::vector<Sample> samples;
      for (Index s = 0; s < room.stations.cols(); ++s)
        samples.push_back(takeSample(room.lit(), creases, room.stations.col(s), laser, options));
      if (options.merged)
        samples = {merge(samples, room.stations)};
      std::printf("noise %g m, %d points per station\n", noise, options.points);
      std::printf("| k = %-28d | beside edges, > 20 | on planes, > 20 | elsewhere, > 20 | s | CPU s |\n"
                  "|---|---|---|---|---|---|\n",
                  options.k);
      compareAtNoise(samples, options.k, common.threads);
      if (options.oracle)
        printOracles(samples, common.threads);
    }
  });
}
