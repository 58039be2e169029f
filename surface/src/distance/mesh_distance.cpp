// SPDX-License-Identifier: BSD-3-Clause
#include "distance/mesh_distance_statistics.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/constants.h>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/search/triangle_tree.h>
#include <fresco/surface/core/mesh_distance.h>
#include <fresco/surface/core/surface_samples.h>
#include <limits>
#include <optional>
namespace fresco {
using namespace distance;
namespace {
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

/// Squares, and sums of several, stay finite in single precision.
constexpr float largest_coordinate = 1e17f;

// One of the two meshes and what the measurements need of it.
struct Side {
  const TriangleMesh& mesh;
  std::vector<int> vertices; // those that count
  std::optional<TriangleTree> surface, points;
};

std::vector<int> countedVertices(const TriangleMesh& mesh)
{
  std::vector<char> counts(mesh.vertexCount(), mesh.faceCount() == 0);
  for (Index i = 0; i < mesh.faces.size(); ++i)
    counts[mesh.faces.data()[i]] = 1;
  std::vector<int> vertices;
  for (int v = 0; v < mesh.vertexCount(); ++v)
    if (counts[v])
      vertices.push_back(v);
  return vertices;
}

// The vertices of `from` that count, in the frame of `to`.
Matrix3Xd verticesInFrame(const Side& from, const TriangleMesh& to)
{
  const Vector3d shift = from.mesh.origin - to.origin;
  return from.mesh.vertices(Eigen::all, from.vertices).cast<double>().colwise() + shift;
}

Side makeSide(const TriangleMesh& mesh, const MeshDistanceOptions& options)
{
  Side side{mesh, countedVertices(mesh), {}, {}};
  if (mesh.faceCount() > 0)
    side.surface.emplace(mesh, options.threads);
  if (options.vertex_to_vertex)
    side.points = TriangleTree::ofPoints(mesh.vertices(Eigen::all, side.vertices), options.threads);
  return side;
}

std::vector<ClosestPoint> measureVertices(const Side& from, const Side& to, const MeshDistanceOptions& options)
{
  return closestPoints(options.vertex_to_vertex ? *to.points : *to.surface, verticesInFrame(from, to.mesh),
                       options.threads);
}

double boxDiagonal(const Side& side)
{
  const Points points = side.mesh.vertices(Eigen::all, side.vertices);
  const Vector3d low = points.rowwise().minCoeff().cast<double>(), high = points.rowwise().maxCoeff().cast<double>();
  return (high - low).norm();
}

Eigen::VectorXf perVertex(const Side& side, const std::vector<ClosestPoint>& closest)
{
  Eigen::VectorXf distances =
      Eigen::VectorXf::Constant(side.mesh.vertexCount(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < closest.size(); ++i)
    distances[side.vertices[i]] = closest[i].distance;
  return distances;
}

Index sampleCount(const MeshDistanceOptions& options)
{
  return options.samples > 0 ? options.samples : options.normal_samples;
}

struct SampleAnswers {
  std::vector<ClosestPoint> closest;
  std::vector<double> angles; // degrees; without those whose closest face has no normal
};

SampleAnswers measureSamples(const Side& from, const Side& to, std::uint64_t seed, const MeshDistanceOptions& options)
{
  const Index count = sampleCount(options);
  SurfaceSamples samples = sampleSurface(from.mesh, count, seed, options.threads);
  samples.points.colwise() += from.mesh.origin - to.mesh.origin;
  SampleAnswers answers{closestPoints(*to.surface, samples.points, options.threads), {}};
  answers.angles.resize(answers.closest.size());
  parallelFor(count, options.threads, [&](Index i) {
    const Vector3d a = areaVector(from.mesh, samples.faces[i]), b = areaVector(to.mesh, answers.closest[i].face);
    const bool defined = a.squaredNorm() > 0.0 && b.squaredNorm() > 0.0;
    answers.angles[i] = defined ? std::atan2(a.cross(b).norm(), a.dot(b)) * degrees_per_radian : -1.0;
  });
  auto& angles = answers.angles;
  angles.erase(std::remove(angles.begin(), angles.end(), -1.0), angles.end());
  return answers;
}

void addSamples(const Side& mesh, const Side& reference, const MeshDistanceOptions& options, MeshDistanceResult& result)
{
  if (sampleCount(options) == 0 || !mesh.surface || !reference.surface)
    return;
  SampleAnswers forth = measureSamples(mesh, reference, options.seed, options);
  SampleAnswers back = measureSamples(reference, mesh, options.seed + 1, options);
  if (options.samples > 0)
    result.surface = twoSided(statistics(forth.closest), statistics(back.closest));
  result.inside_out = mostlyOpposite(forth.angles);
  result.normals_to_reference = deviation(std::move(forth.angles), result.inside_out);
  result.normals_from_reference = deviation(std::move(back.angles), result.inside_out);
}

void validate(const TriangleMesh& mesh, const TriangleMesh& reference, const MeshDistanceOptions& options)
{
  require(options.samples >= 0, "MeshDistance: ", options.samples, " samples");
  require(options.normal_samples >= 0, "MeshDistance: ", options.normal_samples, " samples for normals");
  requireMeasurable(mesh, "MeshDistance: the mesh", !options.vertex_to_vertex);
  requireMeasurable(reference, "MeshDistance: the reference", !options.vertex_to_vertex);
}
} // namespace

void requireMeasurable(const TriangleMesh& mesh, const std::string& name, bool need_faces)
{
  require(mesh.vertexCount() > 0, name, ": no vertices");
  require(mesh.faceCount() > 0 || !need_faces, name, ": no faces (", mesh.vertexCount(), " vertices)");
  require((mesh.origin.array().abs() <= largest_coordinate).all(), name, ": the origin is not finite or too large");
  try {
    validateMesh(mesh);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(name + ": " + error.what());
  }
  for (const int v : countedVertices(mesh)) // NaN is out of range, too
    require((mesh.vertices.col(v).array().abs() <= largest_coordinate).all(), name, ": vertex ", v,
            " is not finite or has a coordinate above ", largest_coordinate);
  require(mesh.faceCount() == 0 || surfaceArea(mesh) > 0.0, name, ": all faces are without area");
}

MeshDistanceResult measureMeshDistance(const TriangleMesh& mesh, const TriangleMesh& reference,
                                       const MeshDistanceOptions& options, const Progress& progress)
{
  validate(mesh, reference, options);
  report(progress, "search structures", 0.0);
  const Side side = makeSide(mesh, options), reference_side = makeSide(reference, options);
  MeshDistanceResult result;
  result.reference_diagonal = boxDiagonal(reference_side);
  require(result.reference_diagonal > 0.0, "MeshDistance: the reference has no extent");
  report(progress, "vertices", 0.3);
  const std::vector<ClosestPoint> forth = measureVertices(side, reference_side, options);
  result.vertex_distances = perVertex(side, forth);
  result.vertices = twoSided(statistics(forth), statistics(measureVertices(reference_side, side, options)));
  report(progress, "normals", 0.6);
  addSamples(side, reference_side, options, result);
  report(progress, "topology", 0.9);
  parallelFor(2, options.threads, [&](Index i) {
    if (i == 0)
      result.mesh_topology = meshTopology(mesh);
    else
      result.reference_topology = meshTopology(reference);
  });
  report(progress, "measured", 1.0);
  return result;
}

Eigen::VectorXf vertexDistances(const TriangleMesh& mesh, const TriangleMesh& reference, int threads)
{
  MeshDistanceOptions options;
  options.threads = threads;
  validate(mesh, reference, options);
  const Side from{mesh, countedVertices(mesh), {}, {}};
  return perVertex(from, closestPoints(TriangleTree(reference, threads), verticesInFrame(from, reference), threads));
}
} // namespace fresco
