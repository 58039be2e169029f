// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/normals_sample.h"
#include "support/tool.h"
#include <chrono>
#include <cstdio>
#include <ctime>
#include <fresco/filters/core/bilateral_normals.h>
#include <fresco/filters/core/oriented_normals.h>
#include <pcl/features/normal_3d_omp.h>
#include <pcl/point_types.h>
/// Normals of laser scans of a generated room against the true ones: pcl::NormalEstimationOMP, estimateNormals() and
/// smoothNormals().
using namespace fresco;
using Eigen::Vector3f;

namespace {
struct Errors {
  double sum[3] = {0, 0, 0}, above_20[3] = {0, 0, 0}, seconds = 0, cpu_seconds = 0;
  Index count[3] = {0, 0, 0};
  void add(const NormalSample& sample, const Points& normals)
  {
    for (Index i = 0; i < normals.cols(); ++i) {
      if (!sample.truth.col(i).allFinite())
        continue;
      const float cosine = sample.truth.col(i).dot(normals.col(i));
      const double angle = std::isfinite(cosine) ? std::acos(std::clamp(cosine, -1.f, 1.f)) * 57.29578 : 180.0;
      const int where = sample.place[i];
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
Points pclNormals(const NormalSample& sample, int k, int threads)
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
    const Vector3f normal = output[i].getNormalVector3fMap();
    normals.col(i) = normal.dot(sample.ray(i)) > 0 ? Vector3f(-normal) : normal;
  }
  return normals;
}

void compareAtNoise(const std::vector<NormalSample>& samples, int k, int threads)
{
  Errors pcl_errors, ours, smooth[3];
  const int rounds[3] = {1, 3, 5};
  for (const NormalSample& sample : samples) {
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
      smooth[r].add(sample, timed(smooth[r], [&] { return smoothNormals(set, normals, smoothing).normals; }));
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
    NormalMeasure options;
    CommonOptions common;
    Args args("fresco_benchmark_normals [options]",
              "Angles between estimated and true normals of generated laser scans, beside edges and elsewhere.");
    args.option("scene", options.scene, "conference_room, apartment or a mesh file");
    args.flag("merged", options.merged, "all stations in one cloud; else each station for itself");
    args.option("stations", options.stations, Range::atLeast(1), "laser stations");
    args.option("points", options.points, Range::atLeast(100), "laser points per station, about");
    args.option("k", options.k, Range::within(3, 1000), "neighbours");
    args.option("edge", options.edge, Range::above(0), "metres to a crease that count as beside an edge");
    common.declare(args);
    args.parse(argc, argv, 0);
    const ScannedRoom room(options.scene, options.stations, common.threads);
    const Creases creases(room.scene.mesh, options, common.threads);
    for (const float noise : {0.002f, 0.005f}) {
      LaserOptions laser;
      laser.points = options.points;
      laser.noise = noise;
      const std::vector<NormalSample> samples = takeSamples(room, creases, laser, options.merged);
      std::printf("noise %g m, %d points per station\n", noise, options.points);
      std::printf("| k = %-28d | beside edges, > 20 | on planes, > 20 | elsewhere, > 20 | s | CPU s |\n"
                  "|---|---|---|---|---|---|\n",
                  options.k);
      compareAtNoise(samples, options.k, common.threads);
    }
  });
}
