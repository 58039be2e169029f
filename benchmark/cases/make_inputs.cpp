// SPDX-License-Identifier: BSD-3-Clause
// Makes point clouds with normals from meshes and scans, for benchmarks. Same arguments, same bytes.
#include "cases/point_normals.h"
#include "support/tool.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <fresco/io/pose_file.h>
#include <fresco/surface/core/surface_samples.h>
#include <random>
namespace {
using namespace fresco;
using Eigen::Vector3d;

struct Options {
  std::string kind, input, output;
  int count = 100000, neighbours = 0, seed = 1;
  double noise = 0.0;
  CommonOptions common;
};

Options parse(int argc, char** argv)
{
  Options options;
  Args args("fresco_benchmark_inputs vertices|surface|scans INPUT OUT.ply [options]",
            "vertices: the vertices of a mesh with its angle-weighted vertex normals.\n"
            "surface: area-uniform samples of a mesh with the normals of its faces.\n"
            "scans: the scans of a folder of fresco_scan, in one frame by the true poses.");
  args.option("count", options.count, Range::atLeast(1), "surface: number of samples");
  args.option("noise", options.noise, Range::atLeast(0),
              "surface: deviation of Gaussian noise, % of the bounding box's diagonal");
  args.option("neighbours", options.neighbours, Range::atLeast(3).zero("as they are; 16 for scans"),
              "normals by principal components of so many neighbours instead, turned to the side they are known to "
              "face; always so for scans");
  args.option("seed", options.seed, Range::atLeast(0), "of samples and noise");
  options.common.declare(args);
  const std::vector<std::string> words = args.parse(argc, argv, 3);
  options.kind = words[0];
  options.input = words[1];
  options.output = words[2];
  if (options.kind != "vertices" && options.kind != "surface" && options.kind != "scans")
    throw UsageError("the kind is vertices, surface or scans, not '" + options.kind + "'");
  return options;
}

Vector3d corner(const TriangleMesh& mesh, Index face, int i)
{
  return mesh.vertices.col(mesh.faces(i % 3, face)).cast<double>();
}

Vector3d faceNormal(const TriangleMesh& mesh, Index face)
{
  const Vector3d a = corner(mesh, face, 0);
  return (corner(mesh, face, 1) - a).cross(corner(mesh, face, 2) - a).normalized();
}

// Thuermer, Wuethrich 1998, "Computing vertex normals from polygonal facets".
PointSet verticesOf(const TriangleMesh& whole)
{
  const TriangleMesh mesh = removeUnreferencedVertices(whole);
  Eigen::Matrix3Xd normals = Eigen::Matrix3Xd::Zero(3, mesh.vertexCount());
  for (Index f = 0; f < mesh.faceCount(); ++f)
    for (int i = 0; i < 3; ++i) {
      const Vector3d to_next = corner(mesh, f, i + 1) - corner(mesh, f, i),
                     to_last = corner(mesh, f, i + 2) - corner(mesh, f, i);
      const double angle = std::atan2(to_next.cross(to_last).norm(), to_next.dot(to_last));
      normals.col(mesh.faces(i, f)) += angle * faceNormal(mesh, f);
    }
  PointSet set;
  set.points = mesh.vertices;
  set.normals = normals.colwise().normalized().cast<float>();
  set.origin = mesh.origin;
  return set;
}

PointSet samplesOf(const TriangleMesh& mesh, const Options& options)
{
  SurfaceSamples samples = sampleSurface(mesh, options.count, options.seed);
  const Eigen::Vector3f extent = mesh.vertices.rowwise().maxCoeff() - mesh.vertices.rowwise().minCoeff();
  std::mt19937_64 random(options.seed);
  std::normal_distribution<double> noise(0.0, 0.01 * options.noise * extent.cast<double>().norm());
  if (options.noise > 0.0)
    for (Index i = 0; i < samples.points.size(); ++i)
      samples.points.data()[i] += noise(random);
  PointSet set;
  set.points = samples.points.cast<float>();
  set.origin = mesh.origin;
  set.normals.resize(3, set.size());
  for (Index i = 0; i < set.size(); ++i)
    set.normals.col(i) = faceNormal(mesh, samples.faces[i]).cast<float>();
  if (options.neighbours > 0)
    set.normals = benchmark::principalNormals(set.points, set.normals, options.neighbours);
  return set;
}

PointSet finitePoints(const PointSet& set)
{
  std::vector<Index> indices;
  for (Index i = 0; i < set.size(); ++i)
    if (set.points.col(i).allFinite())
      indices.push_back(i);
  return selectPoints(set, indices);
}

PointSet mergedScans(const std::string& folder, int neighbours)
{
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder + "/scans"))
    files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  const std::vector<Pose> poses = readPoses(folder + "/poses.txt");
  require(files.size() == poses.size(), folder, ": ", files.size(), " scans, ", poses.size(), " poses");
  PointSet merged;
  for (std::size_t i = 0; i < files.size(); ++i) {
    PointSet scan = finitePoints(readPoints(files[i])); // the scanner stands at zero
    const Points to_scanner = -(scan.points.colwise() + scan.origin.cast<float>());
    scan.normals = benchmark::principalNormals(scan.points, to_scanner, neighbours > 0 ? neighbours : 16);
    scan = transformPoints(scan, poses[i].value());
    merged = i == 0 ? scan : mergePoints(merged, scan);
  }
  return merged;
}

PointSet make(const Options& options)
{
  if (options.kind == "scans")
    return mergedScans(options.input, options.neighbours);
  const TriangleMesh mesh = readMesh(options.input);
  require(mesh.faceCount() > 0, options.input, ": no faces");
  return options.kind == "vertices" ? verticesOf(mesh) : samplesOf(mesh, options);
}
} // namespace

int main(int argc, char** argv)
{
  return runTool("fresco_benchmark_inputs", [&] {
    const Options options = parse(argc, argv);
    writePoints(options.output, make(options));
  });
}
