// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/octree/halo.h"
#include <algorithm>
namespace fresco::poisson {
namespace {
/// Nodes of the brick at offset `d`, as far as they belong to the halo, from those of the brick at offset `h`; else
/// zeros.
void copyPart(const float* nodes, const int d[3], const int h[3], float* halo)
{
  int first[3], last[3];
  for (int a = 0; a < 3; ++a) {
    first[a] = d[a] < 0 ? -1 : d[a] > 0 ? brick_cells : 0;
    last[a] = d[a] == 0 ? brick_cells - 1 : first[a];
  }
  for (int z = first[2]; z <= last[2]; ++z)
    for (int y = first[1]; y <= last[1]; ++y) {
      float* to = halo + haloIndex(first[0], y, z);
      const float* from = nodes ? nodes + nodeIndex(first[0] - 4 * h[0], y - 4 * h[1], z - 4 * h[2]) : nullptr;
      if (d[0] == 0)
        line(to) = from ? line(from) : Line{};
      else
        *to = from ? *from : 0.f;
    }
}
} // namespace

void loadHalo(const BrickLevel& level, Index brick, const NodeField& field, float* halo)
{
  const auto& neighbors = level.neighbors[brick];
  for (int o = 0; o < 27; ++o) {
    const int d[3] = {o % 3 - 1, o / 3 % 3 - 1, o / 9 - 1};
    int h[3] = {d[0], d[1], d[2]}; // offset of the brick that holds the nodes
    int holder = neighbors[o];
    for (int m = 1; m < 8 && holder < 0; ++m) { // else one that has them on its upper faces
      for (int a = 0; a < 3; ++a)
        h[a] = m >> a & 1 ? std::min(d[a], 0) : d[a];
      holder = neighbors[offsetIndex(h[0], h[1], h[2])];
    }
    copyPart(holder < 0 ? nullptr : field.brick(holder), d, h, halo);
  }
}

std::uint64_t fixedNodes(const BrickLevel& level, Index brick)
{
  // Own nodes on the lower faces of the axes in o's bits.
  static const auto on_lower_faces = [] {
    std::array<std::uint64_t, 8> masks{};
    for (int o = 0; o < 8; ++o)
      for (int i = 0; i < own_nodes; ++i)
        if (((o & 1) == 0 || (i & 3) == 0) && ((o & 2) == 0 || (i >> 2 & 3) == 0) && ((o & 4) == 0 || i >> 4 == 0))
          masks[o] |= std::uint64_t(1) << i;
    return masks;
  }();
  const auto& neighbors = level.neighbors[brick];
  std::uint64_t fixed = 0;
  for (int o = 1; o < 8; ++o)
    if (neighbors[offsetIndex(-(o & 1), -(o >> 1 & 1), -(o >> 2))] < 0)
      fixed |= on_lower_faces[o];
  return fixed;
}
} // namespace fresco::poisson
