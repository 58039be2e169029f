// SPDX-License-Identifier: BSD-3-Clause
// Measures the surface optimisation: error of reconstructed meshes before and after it, as a markdown table.
#include "cases/point_normals.h"
#include "experiments/sharp_shapes.h"
#include "support/tool.h"
#include <Eigen/Geometry>
#include <cstdio>
#include <fresco/core/require.h>
#include <fresco/io/mesh_io.h>
#include <fresco/surface/core/mesh_distance.h>
#include <fresco/surface/core/normal_filtering.h>
#include <fresco/surface/core/surface_samples.h>
#include <fresco/surface/core/volumetric_reconstruction.h>
#include <random>
namespace {
using namespace fresco;

struct Request {
  int count = 100000, depth = 7;
  double noise = 0.25;
  std::string keep;
  std::vector<std::string> models;
  bool flip = false;
  CommonOptions common;
};

Request parse(int argc, char** argv)
{
  Request request;
  Args args(
      "fresco_benchmark_optimization [MODEL...] [options]",
      "Samples each model, once exact with its normals and once with noise and normals of 64 neighbours, reconstructs\n"
      "it, optimises the mesh, and prints the errors before and after. Without a MODEL: three shapes with sharp "
      "edges.");
  args.option("count", request.count, Range::atLeast(1), "samples");
  args.option("noise", request.noise, Range::above(0),
              "deviation of Gaussian noise, % of the diagonal of the bounding box");
  args.option("depth", request.depth, Range::within(2, 16), "octree depth of the reconstruction");
  args.flag("flip", request.flip, "with edge flips");
  args.option("keep", request.keep, "folder (must exist) for the meshes: NAME_before.ply, NAME_after.ply");
  request.common.declare(args);
  request.models = args.parse(argc, argv, 0, 100);
  return request;
}

PointSet samplePoints(const TriangleMesh& mesh, const Request& request, bool noisy)
{
  SurfaceSamples samples = sampleSurface(mesh, request.count, 1);
  const Points face_normals = faceNormals(mesh);
  const Eigen::Vector3f extent = mesh.vertices.rowwise().maxCoeff() - mesh.vertices.rowwise().minCoeff();
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0.0, 0.01 * request.noise * extent.cast<double>().norm());
  if (noisy)
    for (Index i = 0; i < samples.points.size(); ++i)
      samples.points.data()[i] += noise(random);
  PointSet set;
  set.points = samples.points.cast<float>();
  set.origin = mesh.origin;
  set.normals = face_normals(Eigen::all, samples.faces);
  if (noisy)
    set.normals = benchmark::principalNormals(set.points, set.normals, 64);
  return set;
}

void printRow(const std::string& name, const TriangleMesh& mesh, const TriangleMesh& reference)
{
  const MeshDistanceResult r = measureMeshDistance(mesh, reference);
  const double percent = 100.0 / r.reference_diagonal;
  const DistanceStatistics& d = r.vertices.symmetric;
  std::printf("| %s | %.3f | %.4f | %.4f | %.2f | %.2f | %s |\n", name.c_str(), d.max * percent, d.mean * percent,
              d.rms * percent, r.normals_to_reference.mean, 100 * r.normals_to_reference.share_above_20,
              r.mesh_topology.watertight ? "yes" : "no");
  std::fflush(stdout);
}

TriangleMesh optimized(const TriangleMesh& mesh, const PointSet& points, const Request& request)
{
  NormalFilteringOptions options;
  options.flip = request.flip;
  options.threads = request.common.threads;
  return filterSurface(mesh, points, options).mesh;
}

void measure(const std::string& name, const TriangleMesh& reference, const Request& request, bool noisy)
{
  const PointSet points = samplePoints(reference, request, noisy);
  VolumetricOptions volumetric;
  volumetric.depth = request.depth;
  const TriangleMesh before = reconstructVolumetric(points, volumetric).mesh;
  const TriangleMesh after = optimized(before, points, request);
  const std::string label = name + (noisy ? ", noisy" : ", exact");
  printRow(label + ", before", before, reference);
  printRow(label + ", after", after, reference);
  if (!request.keep.empty()) {
    const std::string stem = request.keep + "/" + name + (noisy ? "_noisy" : "_exact");
    writeMesh(stem + "_before.ply", before);
    writeMesh(stem + "_after.ply", after);
  }
}

std::string stemOf(const std::string& path)
{
  const std::string file = path.substr(path.find_last_of('/') + 1);
  return file.substr(0, file.find_last_of('.'));
}

void run(const Request& request)
{
  std::vector<std::pair<std::string, TriangleMesh>> models;
  for (const std::string& path : request.models)
    models.emplace_back(stemOf(path), readMesh(path));
  if (models.empty())
    models = {{"box_with_hole", benchmark::boxWithHole()},
              {"gear", benchmark::gear()},
              {"staircase", benchmark::staircase()}};
  std::printf("| shape | max %% | mean %% | RMS %% | normals deg | above 20 deg %% | watertight |\n"
              "|---|---|---|---|---|---|---|\n");
  for (const auto& [name, mesh] : models)
    for (const bool noisy : {false, true})
      measure(name, mesh, request, noisy);
}
} // namespace

int main(int argc, char** argv)
{
  return runTool("fresco_benchmark_optimization", [&] { run(parse(argc, argv)); });
}
