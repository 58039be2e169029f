// SPDX-License-Identifier: BSD-3-Clause
#include "tiles/tile_traces.h"
#include <algorithm>
namespace fresco::texture {
void TileTraces::add(const TileMesh& tile, const PatchMesh& patches, const Eigen::VectorXi& view)
{
  const Index own = ownPatches(tile, patches);
  Trace trace;
  trace.view.assign(view.begin(), view.begin() + own);
  for (Index i = 0; i <= own; ++i)
    if (i == own || i == 0 || patches.parent[i] != patches.parent[i - 1])
      trace.first.push_back(i);
  traces_.push_back(std::move(trace));
}

void TileTraces::setColors(Index tile, const Points& colors)
{
  Array<std::uint8_t>& out = traces_[tile].color;
  out.resize(colors.size());
  for (Index i = 0; i < colors.size(); ++i)
    out[i] = std::clamp(colors.data()[i], 0.f, 255.f) + 0.5f;
}

Index TileTraces::ownPatches(const TileMesh& tile, const PatchMesh& patches)
{
  return std::lower_bound(patches.parent.begin(), patches.parent.end(), tile.own) - patches.parent.begin();
}

/// visit(patch, its own tile's trace, number of the like patch there) for the patches around a tile
template <typename Visit>
void TileTraces::forAround(const TileMesh& tile, const PatchMesh& patches, const Visit& visit) const
{
  for (Index i = ownPatches(tile, patches), in_face = 0; i < patches.size(); ++i) {
    in_face = i > 0 && patches.parent[i] == patches.parent[i - 1] ? in_face + 1 : 0;
    const auto [other, slot] = tile.around[patches.parent[i] - tile.own];
    const Array<int>& first = traces_[other].first; // at the rim, patches are cut otherwise
    visit(i, traces_[other], std::min<Index>(first[slot] + in_face, first[slot + 1] - 1));
  }
}

Eigen::VectorXi TileTraces::views(const TileMesh& tile, Index number, const PatchMesh& patches) const
{
  Eigen::VectorXi out(patches.size());
  std::copy(viewsOf(number).begin(), viewsOf(number).end(), out.begin());
  forAround(tile, patches, [&](Index i, const Trace& trace, Index patch) { out[i] = trace.view[patch]; });
  return out;
}

Points TileTraces::colors(const TileMesh& tile, const PatchMesh& patches) const
{
  Points out = Points::Constant(3, patches.size(), -1.f);
  forAround(tile, patches, [&](Index i, const Trace& trace, Index patch) {
    for (int c = 0; c < 3 && !trace.color.empty(); ++c)
      out(c, i) = trace.color[3 * patch + c];
  });
  return out;
}
} // namespace fresco::texture
