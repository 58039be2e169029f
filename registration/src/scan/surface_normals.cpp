// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/registration/core/surface_points.h>
#include <fresco/search/batch_knn.h>
namespace fresco::registration {
namespace {
struct LocalPlane {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  float surface_variation = 1.f / 3.f; // its largest value: no plane
};

/// @param hits columns of `points`, by distance from `center`
LocalPlane fitPlane(const Points& points, const Eigen::Vector3f& center, const std::vector<int>& hits, float reach)
{
  constexpr int fewest_neighbors = 5; // two more than span a plane: its residual then says something
  constexpr float line_limit = 0.02f; // second / largest eigenvalue: a strip seven times as long as wide, a scan line
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
  int count = 0;
  for (const int hit : hits) {
    const Eigen::Vector3f d = points.col(hit) - center;
    if (d.squaredNorm() > reach * reach)
      break;
    sum += d;
    squares += d * d.transpose();
    ++count;
  }
  if (count < fewest_neighbors)
    return {};
  const float n = count;
  const Eigen::Matrix3f covariance = squares / n - (sum / n) * (sum / n).transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(covariance);
  const Eigen::Vector3f values = solver.eigenvalues().cwiseMax(0.f);
  if (!(values[1] > line_limit * values[2]))
    return {};
  return {solver.eigenvectors().col(0), values[0] / values.sum()};
}

/// use(i, hits) for every point of a level, with its `k` nearest points by distance, itself first. In parallel.
template <typename Use>
void forNeighborhoods(const SurfacePoints& level, int k, int threads, const Use& use)
{
  if (!level.search) {
    const std::vector<int>& columns = level.tree->columns();
    forNearest(*level.tree, k, threads, [&](Index position, const int* found, Index count) {
      std::vector<int> hits(count);
      std::transform(found, found + count, hits.begin(), [&](int place) { return columns[place]; });
      use(columns[position], hits);
    });
    return;
  }
  parallelRanges(level.points.cols(), threads, [&](Index begin, Index end) {
    std::vector<Neighbor> found;
    for (Index i = begin; i < end; ++i) {
      level.search->nearest(level.points.col(i), k, found);
      std::vector<int> hits(found.size());
      std::transform(found.begin(), found.end(), hits.begin(), [](const Neighbor& hit) { return hit.index; });
      use(i, hits);
    }
  });
}

// Direction of a normal, its sign ignored, as one of 5 x 5 x 5 cells.
Index normalBin(const Eigen::Vector3f& normal)
{
  Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const Eigen::Array3f n = (normal * (normal[axis] < 0.f ? -1.f : 1.f)).array();
  const Eigen::Array3f cell = ((n + 1.f) * 2.5f).floor().min(4.f).max(0.f);
  return static_cast<Index>(cell[0] * 25.f + cell[1] * 5.f + cell[2]);
}

// A hash that spreads the points of a bin over the scan.
std::uint32_t scramble(std::uint32_t x)
{
  x = (x ^ (x >> 16)) * 0x7feb352dU;
  x = (x ^ (x >> 15)) * 0x846ca68bU;
  return x ^ (x >> 16);
}
} // namespace

void estimateNormals(SurfacePoints& level, int threads)
{
  constexpr int neighbor_count = 16;         // of a normal: a disc of about two cells' radius
  constexpr float widest_neighborhood = 6.f; // voxels: further points of sparse regions belong to other surfaces
  const Index n = level.points.cols();
  level.normals.resize(3, n);
  level.surface_variation.resize(n);
  level.around.setConstant(level.around.rows(), n, -1);
  forNeighborhoods(level, neighbor_count, threads, [&](Index i, const std::vector<int>& hits) {
    const Eigen::Vector3f point = level.points.col(i);
    for (std::size_t k = 0; k < std::min<std::size_t>(hits.size(), level.around.rows()); ++k)
      level.around(k, i) = hits[k];
    const LocalPlane plane = fitPlane(level.points, point, hits, widest_neighborhood * level.voxel);
    const bool away = plane.normal.dot(level.viewpoints.col(i) - point) < 0.f;
    level.normals.col(i) = away ? Eigen::Vector3f(-plane.normal) : plane.normal;
    level.surface_variation[i] = plane.surface_variation;
  });
}

std::vector<Index> normalSpaceOrder(const SurfacePoints& level)
{
  std::array<std::vector<Index>, 125> bins;
  for (Index i = 0; i < level.points.cols(); ++i)
    if (level.normals.col(i).squaredNorm() > 0.f && level.surface_variation[i] < variation_limit)
      bins[normalBin(level.normals.col(i))].push_back(i);
  std::vector<std::pair<double, Index>> ranked;
  for (std::vector<Index>& bin : bins) {
    std::sort(bin.begin(), bin.end(), [](Index a, Index b) { return scramble(a) < scramble(b); });
    const double size = bin.size();
    for (std::size_t k = 0; k < bin.size(); ++k)
      ranked.emplace_back((k + 0.5) / std::sqrt(size), bin[k]);
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<Index> order;
  for (const auto& entry : ranked)
    order.push_back(entry.second);
  return order;
}
} // namespace fresco::registration
