// SPDX-License-Identifier: BSD-3-Clause
#include "charts/chart_raster.h"
#include "photographs/grid.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fresco/core/grouped.h>
#include <utility>
namespace fresco::texture {
namespace {
constexpr double inside_margin = 1e-3; // texels: on a shared edge no face is inside another

struct Box {
  int x0, y0, x1, y1; ///< texels, both ends included
};

Box boxOf(const Eigen::Matrix<double, 2, 3>& c, const Chart& chart)
{
  return {std::max<int>(0, std::ceil(c.row(0).minCoeff() - 0.5)),
          std::max<int>(0, std::ceil(c.row(1).minCoeff() - 0.5)),
          std::min<int>(chart.width - 1, std::floor(c.row(0).maxCoeff() - 0.5)),
          std::min<int>(chart.height - 1, std::floor(c.row(1).maxCoeff() - 0.5))};
}

/// Distances of texel centres from a patch's sides, positive inside: linear functions of the place. Corners run
/// clockwise in a frame whose y points down as they run counter-clockwise seen from outside.
class SideDistances {
public:
  /// @param either whether the corners may also run the other way
  SideDistances(const Eigen::Matrix<double, 2, 3>& c, bool either)
  {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector2d edge =
          (c.col((k + 1) % 3) - c.col(k)) / std::max((c.col((k + 1) % 3) - c.col(k)).norm(), 1e-12);
      sides_.row(k) << edge.y(), -edge.x(), edge.x() * c(1, k) - edge.y() * c(0, k);
    }
    const Eigen::Vector2d u = c.col(1) - c.col(0), v = c.col(2) - c.col(0);
    if (either && u.x() * v.y() - u.y() * v.x() > 0)
      sides_ = -sides_;
  }

  double least(const Eigen::Vector2d& p) const { return (sides_ * p.homogeneous()).minCoeff(); }

private:
  Eigen::Matrix3d sides_;
};

/// visit(texel index, depth inside) for each texel whose centre the patch covers
template <typename Visit>
void forTexels(const PatchMesh& patches, const Chart& chart, int patch, const Visit& visit)
{
  const Eigen::Matrix<double, 2, 3> c = patchTexels(patches, chart, patch);
  const Box box = boxOf(c, chart);
  const SideDistances distances(c, chart.given != nullptr); // layouts of others may be mirrored
  for (int y = box.y0; y <= box.y1; ++y)
    for (int x = box.x0; x <= box.x1; ++x)
      if (const double depth = distances.least({x + 0.5, y + 0.5}); depth >= -inside_margin)
        visit(cellAt(x, y, chart.width), depth);
}

class Raster {
public:
  Raster(const PatchMesh& patches, const std::vector<Index>& first_patch, const Chart& chart)
      : patches_(patches), first_(first_patch), chart_(chart), claimed_(cellCount(chart.width, chart.height), 0),
        owner_(claimed_.size(), -1)
  {}

  /// @return false if the face would cover a texel that is firmly another's; nothing is drawn then
  bool draw(int face)
  {
    bool free = true;
    covered_.clear();
    for (Index i = first_[face]; i < first_[face + 1] && free; ++i)
      forTexels(patches_, chart_, i, [&](std::size_t at, double depth) {
        free = free && !(claimed_[at] && depth > inside_margin && patches_.parent[owner_[at]] != face);
        covered_.push_back({at, int(i), depth > inside_margin});
      });
    for (std::size_t k = 0; k < covered_.size() && free; ++k) {
      const auto& [at, patch, firmly] = covered_[k];
      if (owner_[at] < 0 || firmly)
        owner_[at] = patch;
      claimed_[at] = claimed_[at] || firmly;
    }
    return free;
  }

  /// The texel under the middle of a patch that covers no texel's centre, so that it is not left without colour.
  void drawSmallPatch(int patch)
  {
    const Eigen::Vector2d middle = patchTexels(patches_, chart_, patch).rowwise().mean();
    const int x = std::clamp<int>(middle.x(), 0, chart_.width - 1),
              y = std::clamp<int>(middle.y(), 0, chart_.height - 1);
    int& owner = owner_[cellAt(x, y, chart_.width)];
    if (owner < 0)
      owner = patch;
  }

  /// Rows from the top: patch of each texel, -1 = none.
  std::vector<int> takeOwners() { return std::move(owner_); }

private:
  struct Covered {
    std::size_t at; ///< texel
    int patch;
    bool firmly; ///< not only by its edge
  };

  const PatchMesh& patches_;
  const std::vector<Index>& first_;
  const Chart& chart_;
  std::vector<Covered> covered_; ///< by the face in work
  std::vector<char> claimed_;    ///< whether the owner's inside, not only its edge, covers the texel's centre
  std::vector<int> owner_;
};

/// Texels without owner take that of a neighbour, round by round.
void growOwners(int rounds, int width, std::vector<int>& owner)
{
  const int offsets[8][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
  const int height = owner.size() / width;
  for (int round = 0; round < rounds; ++round) {
    const std::vector<int> before = owner;
    for (std::size_t at = 0; at < owner.size(); ++at)
      for (int k = 0; k < 8 && owner[at] < 0; ++k) {
        const int x = at % width + offsets[k][0], y = at / width + offsets[k][1];
        if (x >= 0 && y >= 0 && x < width && y < height)
          owner[at] = before[cellAt(x, y, width)];
      }
  }
}
} // namespace

std::vector<Index> patchesOfFaces(const PatchMesh& patches, Index faces)
{
  return grouped(patches.size(), faces, [&](Index i) { return patches.parent[i]; }).begin;
}

Eigen::Matrix<double, 2, 3> patchTexels(const PatchMesh& patches, const Chart& chart, Index patch)
{
  const Eigen::Matrix3f corners = patches.corners(patch);
  Eigen::Matrix<double, 2, 3> out;
  for (int k = 0; k < 3; ++k)
    out.col(k) =
        chart.given
            ? Eigen::Vector2d((*chart.given)[patches.parent[patch]] * corners.col(k).cast<double>().homogeneous()) -
                  Eigen::Vector2d(chart.x, chart.y)
            : chart.texel(corners.col(k));
  return out;
}

std::vector<int> rasterizeChart(const PatchMesh& patches, const std::vector<Index>& first_patch, int border,
                                Chart& chart)
{
  Raster raster(patches, first_patch, chart);
  std::vector<int> kept, out;
  for (const int face : chart.faces)
    (raster.draw(face) ? kept : out).push_back(face);
  chart.faces = std::move(kept);
  for (const int face : chart.faces)
    for (Index i = first_patch[face]; i < first_patch[face + 1]; ++i)
      raster.drawSmallPatch(i);
  std::vector<int> owner = raster.takeOwners();
  growOwners(border, chart.width, owner);
  chart.texels = OwnedTexels::from(owner, chart.width);
  return out;
}
} // namespace fresco::texture
