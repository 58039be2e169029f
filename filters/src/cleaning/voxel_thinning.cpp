// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fresco/core/parallel.h>
#include <fresco/core/point_set.h>
#include <fresco/core/require.h>
#include <fresco/filters/core/voxel_thinning.h>
#include <tuple>
namespace fresco {
namespace {
constexpr int axis_bits = 21;

Eigen::AlignedBox3f finiteBounds(const Points& points, int threads)
{
  return parallelReduce(
      points.cols(), threads, Eigen::AlignedBox3f(),
      [&](Index begin, Index end) {
        Eigen::AlignedBox3f box;
        for (Index i = begin; i < end; ++i)
          if (points.col(i).allFinite())
            box.extend(Eigen::Vector3f(points.col(i)));
        return box;
      },
      [](const Eigen::AlignedBox3f& a, const Eigen::AlignedBox3f& b) { return a.merged(b); });
}

struct Entry {
  std::uint64_t cell;
  Index point;
};

/// Finite points with their cells, sorted by cell, then coordinates: what follows does not depend on their order.
std::vector<Entry> sortedByCell(const Points& points, const Eigen::AlignedBox3f& box, float cell, int threads)
{
  const std::vector<Index> finite = finiteColumns(points);
  std::vector<Entry> entries(finite.size());
  const Eigen::Vector3d low = box.min().cast<double>();
  parallelFor(entries.size(), threads, [&](Index k) {
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis)
      key = key << axis_bits | static_cast<std::uint64_t>((points(axis, finite[k]) - low[axis]) / cell);
    entries[k] = {key, finite[k]};
  });
  const auto place = [&](Index i) { return std::tuple(points(0, i), points(1, i), points(2, i), i); };
  std::sort(entries.begin(), entries.end(), [&](const Entry& a, const Entry& b) {
    return a.cell != b.cell ? a.cell < b.cell : place(a.point) < place(b.point);
  });
  return entries;
}
} // namespace

VoxelThinning thinByVoxel(const Points& points, float cell, int threads)
{
  require(cell > 0 && std::isfinite(cell), "voxel thinning: cell size ", cell, " is not above 0");
  const Eigen::AlignedBox3f box = finiteBounds(points, threads);
  require(box.isEmpty() || (box.max() - box.min()).maxCoeff() / cell < (1 << axis_bits), "voxel thinning: cell size ",
          cell, " is too small for an extent of ", box.isEmpty() ? 0.f : (box.max() - box.min()).maxCoeff());
  const std::vector<Entry> entries = sortedByCell(points, box, cell, threads);
  std::vector<std::pair<Index, Eigen::Vector3f>> found; // kept point, centroid
  for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (end = begin; end < entries.size() && entries[end].cell == entries[begin].cell; ++end)
      sum += points.col(entries[end].point).cast<double>();
    const Eigen::Vector3d centroid = sum / static_cast<double>(end - begin);
    const auto nearer = [&](const Entry& a, const Entry& b) {
      return (points.col(a.point).cast<double>() - centroid).squaredNorm() <
             (points.col(b.point).cast<double>() - centroid).squaredNorm();
    };
    const auto nearest = std::min_element(entries.begin() + begin, entries.begin() + end, nearer);
    found.emplace_back(nearest->point, centroid.cast<float>());
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  VoxelThinning result{{}, Points(3, found.size())};
  for (std::size_t v = 0; v < found.size(); ++v) {
    result.kept.push_back(found[v].first);
    result.centroids.col(v) = found[v].second;
  }
  return result;
}
} // namespace fresco
