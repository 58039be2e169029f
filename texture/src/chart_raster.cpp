// SPDX-License-Identifier: BSD-3-Clause
#include "chart_raster.h"
#include <algorithm>
#include <cmath>
namespace fresco {
namespace {
constexpr double inside_margin = 1e-3; // texels: on a shared edge no face is inside another

struct Box {
  int x0, y0, x1, y1; ///< texels, both ends included
};

Box boxOf(const Eigen::Matrix<double, 2, 3>& c, const Chart& chart)
{
  return {std::max(0, static_cast<int>(std::ceil(c.row(0).minCoeff() - 0.5))),
          std::max(0, static_cast<int>(std::ceil(c.row(1).minCoeff() - 0.5))),
          std::min(chart.width - 1, static_cast<int>(std::floor(c.row(0).maxCoeff() - 0.5))),
          std::min(chart.height - 1, static_cast<int>(std::floor(c.row(1).maxCoeff() - 0.5)))};
}

/// Distance of `p` from the nearest side in texels, positive inside. Corners run clockwise in a frame whose y points
/// down as they run counter-clockwise seen from outside.
double depthInside(const Eigen::Matrix<double, 2, 3>& c, const Eigen::Vector2d& p)
{
  double depth = 1e30;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector2d edge = c.col((k + 1) % 3) - c.col(k), to = p - c.col(k);
    depth = std::min(depth, (edge.y() * to.x() - edge.x() * to.y()) / std::max(edge.norm(), 1e-12));
  }
  return depth;
}

/// visit(texel index, depth inside) for each texel whose centre the patch covers
template <typename Visit>
void forTexels(const PatchMesh& patches, const Chart& chart, int patch, const Visit& visit)
{
  const Eigen::Matrix<double, 2, 3> c = patchTexels(patches, chart, patch);
  const Box box = boxOf(c, chart);
  for (int y = box.y0; y <= box.y1; ++y)
    for (int x = box.x0; x <= box.x1; ++x)
      if (const double depth = depthInside(c, {x + 0.5, y + 0.5}); depth >= -inside_margin)
        visit(static_cast<std::size_t>(y) * chart.width + x, depth);
}

class Raster {
public:
  Raster(const PatchMesh& patches, const std::vector<int>& first_patch, Chart& chart)
      : patches_(patches), first_(first_patch), chart_(chart),
        claimed_(static_cast<std::size_t>(chart.width) * chart.height, 0)
  {
    chart.owner.assign(claimed_.size(), -1);
  }

  /// @return false if the face would cover a texel that is firmly another's; nothing is drawn then
  bool draw(int face)
  {
    bool free = true;
    for (int i = first_[face]; i < first_[face + 1] && free; ++i)
      forTexels(patches_, chart_, i, [&](std::size_t at, double depth) {
        free = free && !(claimed_[at] && depth > inside_margin && patches_.parent[chart_.owner[at]] != face);
      });
    for (int i = first_[face]; i < first_[face + 1] && free; ++i)
      forTexels(patches_, chart_, i, [&](std::size_t at, double depth) {
        if (chart_.owner[at] < 0 || depth > inside_margin)
          chart_.owner[at] = i;
        claimed_[at] = claimed_[at] || depth > inside_margin;
      });
    return free;
  }

private:
  const PatchMesh& patches_;
  const std::vector<int>& first_;
  Chart& chart_;
  std::vector<char> claimed_; ///< whether the owner's inside, not only its edge, covers the texel's centre
};

/// Texels without owner take that of a neighbour, round by round.
void growOwners(Chart& chart, int rounds)
{
  const int offsets[8][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
  for (int round = 0; round < rounds; ++round) {
    const std::vector<int> before = chart.owner;
    for (int y = 0; y < chart.height; ++y)
      for (int x = 0; x < chart.width; ++x) {
        int& owner = chart.owner[static_cast<std::size_t>(y) * chart.width + x];
        for (int k = 0; k < 8 && owner < 0; ++k) {
          const int i = x + offsets[k][0], j = y + offsets[k][1];
          if (i >= 0 && j >= 0 && i < chart.width && j < chart.height)
            owner = before[static_cast<std::size_t>(j) * chart.width + i];
        }
      }
  }
}

/// The texel under the middle of a patch that covers no texel's centre, so that it is not left without colour.
void drawSpeck(const PatchMesh& patches, int patch, Chart& chart)
{
  const Eigen::Vector2d middle = patchTexels(patches, chart, patch).rowwise().mean();
  const int x = std::clamp(static_cast<int>(middle.x()), 0, chart.width - 1),
            y = std::clamp(static_cast<int>(middle.y()), 0, chart.height - 1);
  int& owner = chart.owner[static_cast<std::size_t>(y) * chart.width + x];
  if (owner < 0)
    owner = patch;
}
} // namespace

std::vector<int> patchesOfFaces(const PatchMesh& patches, Index faces)
{
  std::vector<int> first(static_cast<std::size_t>(faces) + 1, 0);
  for (Index i = 0; i < patches.size(); ++i)
    ++first[patches.parent[i] + 1];
  for (Index f = 0; f < faces; ++f)
    first[f + 1] += first[f];
  return first;
}

Eigen::Matrix<double, 2, 3> patchTexels(const PatchMesh& patches, const Chart& chart, Index patch)
{
  Eigen::Matrix<double, 2, 3> out;
  for (int k = 0; k < 3; ++k)
    out.col(k) = chart.texel(patches.vertices.col(patches.faces(k, patch)));
  return out;
}

Eigen::Vector3d barycentric(const Eigen::Matrix<double, 2, 3>& corners, const Eigen::Vector2d& p)
{
  const Eigen::Vector2d u = corners.col(1) - corners.col(0), v = corners.col(2) - corners.col(0),
                        w = p - corners.col(0);
  const double det = u.x() * v.y() - u.y() * v.x();
  if (!(std::abs(det) > 1e-12))
    return Eigen::Vector3d::Constant(1.0 / 3);
  const double b = (w.x() * v.y() - w.y() * v.x()) / det, c = (u.x() * w.y() - u.y() * w.x()) / det;
  return {1 - b - c, b, c};
}

std::vector<int> rasterizeChart(const PatchMesh& patches, const std::vector<int>& first_patch, int border, Chart& chart)
{
  Raster raster(patches, first_patch, chart);
  std::vector<int> kept, out;
  for (const int face : chart.faces)
    (raster.draw(face) ? kept : out).push_back(face);
  chart.faces = std::move(kept);
  for (const int face : chart.faces)
    for (int i = first_patch[face]; i < first_patch[face + 1]; ++i)
      drawSpeck(patches, i, chart);
  growOwners(chart, border);
  return out;
}
} // namespace fresco
