// SPDX-License-Identifier: BSD-3-Clause
#include "points/surface_samples.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/constants.h>
#include <fresco/core/parallel.h>
#include <fresco/core/statistics.h>
#include <fresco/search/batch_knn.h>
#include <fresco/search/triangle_tree.h>
#include <limits>
#include <map>
#include <tuple>
namespace fresco::texture {
namespace {
/// Points with the nearest face of each.
struct Feet {
  std::vector<Index> points;
  Points places;
  std::vector<int> faces;
  std::vector<float> distances;
};

/// How far from a tile points are looked for, mesh units: those of one tile are looked for everywhere.
float reachOf(const TriangleMesh& mesh, const MeshTiles& tiles)
{
  constexpr float edges = 10; // what is farther away is no noise
  const float far = std::numeric_limits<float>::infinity();
  return tiles.count() == 1 ? far : edges * static_cast<float>(meanEdge(mesh, far));
}

/// Points up to `reach` from the tile; numbers of feet.
std::vector<Index> feetNear(const Eigen::AlignedBox3f& tile, float reach, const PointSet& set,
                            const Eigen::Vector3d& shift, const Feet& feet)
{
  const Eigen::AlignedBox3d box(tile.min().cast<double>().array() - reach, tile.max().cast<double>().array() + reach);
  std::vector<Index> out;
  for (std::size_t i = 0; i < feet.points.size(); ++i)
    if (box.contains(Eigen::Vector3d(set.points.col(feet.points[i]).cast<double>() + shift)))
      out.push_back(i);
  return out;
}

/// A part of the mesh.
struct TileTree {
  TriangleTree tree;
  const int* faces; ///< numbers in the mesh
};

/// Moves the chosen points to the tile where that is nearer than what was there before.
void addFeet(const TileTree& tile, const Eigen::Matrix3Xd& queries, const Index* chosen, int threads, Feet& feet)
{
  const std::vector<ClosestPoint> closest = closestPoints(tile.tree, queries, threads);
  for (Index i = 0; i < queries.cols(); ++i) {
    const Index to = chosen[i];
    if (!(closest[i].distance < feet.distances[to]))
      continue;
    feet.places.col(to) = closest[i].point.cast<float>();
    feet.faces[to] = tile.faces[closest[i].face];
    feet.distances[to] = closest[i].distance;
  }
}

/// Leaves out all but the feet for whose numbers keep() holds; places beyond them are of no use.
template <typename Keep>
void keepFeet(Feet& feet, const Keep& keep)
{
  Index kept = 0;
  for (std::size_t i = 0; i < feet.faces.size(); ++i)
    if (keep(i)) {
      feet.points[kept] = feet.points[i];
      feet.faces[kept] = feet.faces[i];
      feet.distances[kept] = feet.distances[i];
      feet.places.col(kept++) = feet.places.col(i).eval();
    }
  feet.points.resize(kept);
  feet.faces.resize(kept);
  feet.distances.resize(kept);
}

Feet feetOf(const TriangleMesh& mesh, const MeshTiles& tiles, const PointSet& set, int threads)
{
  constexpr Index window = 1 << 20; // points at a time: bounds the memory
  Feet feet;
  feet.points = finiteColumns(set.points);
  feet.places.resize(3, feet.points.size());
  feet.faces.assign(feet.points.size(), -1);
  feet.distances.assign(feet.points.size(), std::numeric_limits<float>::infinity());
  const Eigen::Vector3d shift = set.origin - mesh.origin;
  const float reach = reachOf(mesh, tiles);
  for (Index t = 0; t < tiles.count(); ++t) {
    const std::vector<Index> chosen = feetNear(tiles.boxes[t], reach, set, shift, feet);
    if (chosen.empty())
      continue;
    const TileTree tile{TriangleTree(tiles.count() == 1 ? mesh : tileMesh(mesh, tiles, t, -1).mesh, threads),
                        tiles.order.data() + tiles.begin[t]};
    const Index n = chosen.size();
    for (Index first = 0; first < n; first += window) {
      Eigen::Matrix3Xd queries(3, std::min(window, n - first));
      for (Index i = 0; i < queries.cols(); ++i)
        queries.col(i) = set.points.col(feet.points[chosen[first + i]]).cast<double>() + shift;
      addFeet(tile, queries, chosen.data() + first, threads, feet);
    }
  }
  keepFeet(feet, [&](Index i) { return feet.faces[i] >= 0; });
  return feet;
}

/// Cosine-like number, positive where the point was seen from the side that the normal points to; 0 = not known.
float sideOf(const PointSet& set, Index point, const Eigen::Vector3f& normal)
{
  if (set.hasNormals())
    return set.normals.col(point).dot(normal);
  if (set.viewpoints.cols() == 0)
    return 0;
  const Eigen::Vector3f eye = set.viewpoints.col(set.viewpoints.cols() == 1 ? 0 : point);
  return (eye - set.points.col(point)).normalized().dot(normal);
}

/// Numbers the viewpoints.
void findScans(const PointSet& set, const Eigen::Vector3d& mesh_origin, SurfaceSamples& samples)
{
  constexpr std::size_t most_scans = 1000; // more are the path of a moving scanner, with one exposure
  samples.scan.assign(samples.points.size(), 0);
  samples.stations = Points::Zero(3, 1);
  const Eigen::Vector3f shift = (set.origin - mesh_origin).cast<float>();
  if (set.viewpoints.cols() == 1)
    samples.stations.col(0) = set.viewpoints.col(0) + shift;
  if (set.viewpoints.cols() <= 1)
    return;
  std::map<std::tuple<float, float, float>, int> numbers;
  for (Index i = 0; i < samples.size() && numbers.size() <= most_scans; ++i) {
    const auto eye = set.viewpoints.col(samples.points[i]);
    samples.scan[i] = numbers.try_emplace({eye.x(), eye.y(), eye.z()}, numbers.size()).first->second;
  }
  if (numbers.size() > most_scans) {
    std::fill(samples.scan.begin(), samples.scan.end(), 0);
    return;
  }
  samples.stations.resize(3, numbers.size());
  for (const auto& [eye, number] : numbers)
    samples.stations.col(number) = Eigen::Vector3f(std::get<0>(eye), std::get<1>(eye), std::get<2>(eye)) + shift;
}

void measureSpacing(int threads, SurfaceSamples& samples)
{
  constexpr int neighbors = 16; // a mean over four rows of a grid
  samples.spacing = Eigen::VectorXf::Zero(samples.size());
  forNearest(*samples.tree, neighbors, threads, [&](Index at, const int* found, Index count) {
    const std::vector<int>& columns = samples.tree->columns();
    const int i = columns[at];
    float farthest = 0;
    int agreeing = 0;
    for (Index k = 0; k < count; ++k)
      if (const int other = columns[found[k]];
          samples.normals.col(i).dot(samples.normals.col(other)) > SurfaceGaussian::same_side) {
        farthest = std::max(farthest, (samples.places.col(i) - samples.places.col(other)).norm());
        ++agreeing;
      }
    samples.spacing[i] = farthest * std::sqrt(float(pi) / std::max(1, agreeing - 1));
  });
  std::vector<float> sorted(samples.spacing.begin(), samples.spacing.end());
  if (!sorted.empty()) // points on one place, or alone on their side
    samples.spacing = samples.spacing.cwiseMax(1e-3f * median(sorted));
}
} // namespace

SurfaceSamples sampleSurface(const TriangleMesh& mesh, const MeshTiles& tiles, const PointSet& points, int threads)
{
  const Points normals = faceNormals(mesh, threads);
  Feet feet = feetOf(mesh, tiles, points, threads);
  double side = 0;
  for (std::size_t i = 0; i < feet.points.size(); ++i)
    side += sideOf(points, feet.points[i], normals.col(feet.faces[i]));
  const float front = side < 0 ? -1 : 1; // a mesh may be turned inside out as a whole
  const float noise = feet.distances.empty() ? 0 : mad_to_sigma * median(std::vector<float>(feet.distances));
  const float rounding = 1e-6f * (mesh.vertices.rowwise().maxCoeff() - mesh.vertices.rowwise().minCoeff()).norm();
  keepFeet(feet, [&](Index i) {
    const auto normal = normals.col(feet.faces[i]);
    return !(feet.distances[i] > SurfaceGaussian::reach * noise + rounding) && normal.squaredNorm() > 0 &&
           !(front * sideOf(points, feet.points[i], normal) < 0);
  });
  SurfaceSamples samples;
  samples.points = std::move(feet.points);
  samples.places = feet.places.leftCols(samples.size());
  samples.normals = normals(Eigen::all, feet.faces);
  findScans(points, mesh.origin, samples);
  samples.tree = std::make_unique<PointTree>(samples.places, threads);
  measureSpacing(threads, samples);
  return samples;
}

void SurfaceGaussian::gather(const Eigen::Vector3f& middle, float radius, std::vector<int>& found) const
{
  constexpr float wider = 2; // spacing next to the nearest sample: beyond twice its own is a jump of density
  found.clear();
  const Neighbor nearest = samples_.tree->nearest(middle);
  if (nearest.index < 0)
    return;
  const float spread = reach * width_ * samples_.spacing[nearest.index];
  if (std::sqrt(nearest.squared_distance) > radius + spread)
    return;
  static thread_local std::vector<PointTree::Key> keys;
  samples_.tree->withinKeys(middle, radius + wider * spread, keys);
  for (const PointTree::Key key : keys)
    found.push_back(samples_.tree->columns()[PointTree::position(key)]);
}

Eigen::Vector4f SurfaceGaussian::at(const Eigen::Vector3f& place, const Eigen::Vector3f& normal,
                                    const std::vector<int>& found, const Points& values) const
{
  Eigen::Vector4f sum = Eigen::Vector4f::Zero();
  for (const int i : found) {
    const float deviation = width_ * samples_.spacing[i];
    const float squared = (samples_.places.col(i) - place).squaredNorm() / (deviation * deviation);
    const float side = samples_.normals.col(i).dot(normal);
    if (!(squared < reach * reach) || side <= same_side)
      continue;
    const float weight = std::exp(-0.5f * squared) * (side - same_side) / (1 - same_side);
    sum += weight * values.col(i).homogeneous();
  }
  return sum;
}
} // namespace fresco::texture
