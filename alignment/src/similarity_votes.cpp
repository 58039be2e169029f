// SPDX-License-Identifier: BSD-3-Clause
#include "similarity_votes.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <map>
namespace fresco::alignment {
namespace {
using Eigen::Array3i;
using Eigen::Vector3d;

/// Directions of normals, sign ignored: those of a cube's sides, edges and corners.
const std::vector<Vector3d>& directionBins()
{
  static const std::vector<Vector3d> bins = [] {
    std::vector<Vector3d> all;
    for (const Vector3d& d :
         {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1), Vector3d(1, 1, 0), Vector3d(1, -1, 0),
          Vector3d(1, 0, 1), Vector3d(1, 0, -1), Vector3d(0, 1, 1), Vector3d(0, 1, -1), Vector3d(1, 1, 1),
          Vector3d(1, 1, -1), Vector3d(1, -1, 1), Vector3d(-1, 1, 1)})
      all.push_back(d.normalized());
    return all;
  }();
  return bins;
}

/// The surface in cells for one scale, by the direction of their normals.
struct SurfaceCells {
  double cell = 1; ///< length
  Array3i low, counts;
  std::vector<std::vector<Array3i>> cells = std::vector<std::vector<Array3i>>(directionBins().size());
};

int nearestBin(const Vector3d& normal)
{
  int best = 0;
  for (std::size_t b = 1; b < directionBins().size(); ++b)
    if (std::abs(directionBins()[b].dot(normal)) > std::abs(directionBins()[best].dot(normal)))
      best = static_cast<int>(b);
  return best;
}

SurfaceCells surfaceCells(const ScanSurface& surface, double cell)
{
  constexpr double thickness = 0.35; // cells to either side: a point that is off by half a cell still votes
  SurfaceCells out;
  out.cell = cell;
  out.low = (surface.low().cast<double>() / cell).array().floor().cast<int>();
  out.counts = (surface.high().cast<double>() / cell).array().floor().cast<int>() + 1 - out.low;
  const registration::SurfacePoints& level = surface.level();
  std::vector<std::uint64_t> keys;
  for (Index i = 0; i < level.points.cols(); ++i) {
    const Vector3d normal = level.normals.col(i).cast<double>();
    if (!(normal.squaredNorm() > 0) || level.surface_variation[i] > registration::variation_limit)
      continue;
    const std::uint64_t bin = nearestBin(normal);
    for (const double side : {-thickness, thickness}) {
      const Array3i at =
          (level.points.col(i).cast<double>() / cell + side * normal).array().floor().cast<int>() - out.low;
      if ((at >= 0).all() && (at < out.counts).all())
        keys.push_back(bin << 60 | std::uint64_t(at[2]) << 40 | std::uint64_t(at[1]) << 20 | std::uint64_t(at[0]));
    }
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  for (const std::uint64_t key : keys)
    out.cells[key >> 60].push_back({int(key & 0xfffff), int(key >> 20 & 0xfffff), int(key >> 40 & 0xfffff)});
  return out;
}

/// The shifts of most votes for one rotation and scale.
std::vector<VotedSimilarity> bestShifts(const SparseModel& model, const SurfaceCells& surface, const Similarity& turned)
{
  constexpr std::size_t voters = 200, kept = 4;
  constexpr double alike = 0.75; // cosine, of a normal and the direction of a bin: 41 degrees
  constexpr int apart = 3;       // cells between two places
  const Array3i n = surface.counts;
  std::vector<std::uint16_t> votes(n.cast<std::size_t>().prod(), 0); // by the cell that the model's origin comes to
  for (std::size_t k = 0; k < std::min(voters, model.order.size()); ++k) {
    const Vector3d normal = turned.R * model.normals.col(model.order[k]);
    const Array3i offset =
        ((turned * model.points.col(model.spread[model.order[k]])) / surface.cell).array().round().cast<int>();
    for (std::size_t b = 0; b < surface.cells.size(); ++b)
      if (std::abs(directionBins()[b].dot(normal)) > alike)
        for (const Array3i& cell : surface.cells[b]) {
          const Array3i at = cell - offset;
          if ((at >= 0).all() && (at < n).all())
            ++votes[(std::size_t(at[2]) * n[1] + at[1]) * n[0] + at[0]];
        }
  }
  std::vector<VotedSimilarity> best;
  std::vector<Array3i> places;
  while (best.size() < kept) {
    const auto top = std::max_element(votes.begin(), votes.end());
    const Index index = top - votes.begin();
    const Array3i at(static_cast<int>(index % n[0]), static_cast<int>(index / n[0] % n[1]),
                     static_cast<int>(index / (Index{n[0]} * n[1])));
    Similarity T = turned;
    T.t = surface.cell * ((at + surface.low).cast<double>() + 0.5).matrix();
    best.push_back({T, *top});
    for (int z = std::max(0, at[2] - apart); z <= std::min(n[2] - 1, at[2] + apart); ++z)
      for (int y = std::max(0, at[1] - apart); y <= std::min(n[1] - 1, at[1] + apart); ++y)
        for (int x = std::max(0, at[0] - apart); x <= std::min(n[0] - 1, at[0] + apart); ++x)
          votes[(std::size_t(z) * n[1] + y) * n[0] + x] = 0;
  }
  return best;
}
} // namespace

std::vector<VotedSimilarity> voteForSimilarities(const SparseModel& model, const ScanSurface& surface,
                                                 const std::vector<Eigen::Matrix3d>& rotations,
                                                 const std::pair<double, double>& scales, int threads,
                                                 const Progress& progress)
{
  constexpr double step = 1.045; // moves points at 1.8 radii by a cell
  const double box = (surface.high() - surface.low()).cast<double>().prod();
  std::vector<VotedSimilarity> all;
  for (double scale = scales.first; scale < scales.second; scale *= step) {
    report(progress, "place", std::log(scale / scales.first) / std::log(scales.second / scales.first));
    const double cell = std::max({scale * vote_cell, surface.grain(), std::cbrt(box / most_cells)});
    const SurfaceCells cells = surfaceCells(surface, cell);
    std::vector<std::vector<VotedSimilarity>> found(rotations.size());
    parallelFor(
        found.size(), threads,
        [&](Index r) {
          found[r] = bestShifts(model, cells, {scale, rotations[r], Vector3d::Zero()});
        },
        1);
    for (const auto& some : found)
      all.insert(all.end(), some.begin(), some.end());
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.votes > b.votes; });
  return all;
}
} // namespace fresco::alignment
