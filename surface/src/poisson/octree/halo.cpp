// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/octree/halo.h"
#include <utility>
namespace fresco::poisson {
namespace {
/// A part of the halo: where it begins and ends on each axis.
struct HaloPart {
  int first[3], last[3];
};

/// @param d offset of the brick that the nodes lie in
constexpr HaloPart partAt(const int d[3])
{
  HaloPart part{};
  for (int a = 0; a < 3; ++a) {
    part.first[a] = d[a] < 0 ? -1 : d[a] > 0 ? brick_cells : 0;
    part.last[a] = d[a] == 0 ? brick_cells - 1 : part.first[a];
  }
  return part;
}

/// @param from   the part's first node; nullptr for zeros
/// @param step_y, step_z to the next node of `from`; to that on the x axis it is 1
inline void copyPart(const HaloPart& part, const float* from, int step_y, int step_z, float* halo)
{
  const bool row = part.first[0] < part.last[0];
  for (int z = part.first[2]; z <= part.last[2]; ++z)
    for (int y = part.first[1]; y <= part.last[1]; ++y) {
      float* to = halo + haloIndex(part.first[0], y, z);
      const float* at = from ? from + (y - part.first[1]) * step_y + (z - part.first[2]) * step_z : nullptr;
      if (row)
        line(to) = at ? line(at) : Line{};
      else
        *to = at ? *at : 0.f;
    }
}

/// The same from the rim of a brick that has the nodes on its upper faces, if there is one.
void copyRim(const BrickLevel& level, const Neighbors& neighbors, const NodeField& field, const int d[3], float* halo)
{
  const int above = (d[0] > 0) | (d[1] > 0) << 1 | (d[2] > 0) << 2;
  const HaloPart part = partAt(d);
  for (int axes = 1; axes < 8; ++axes) {
    if ((axes & above) != axes)
      continue;
    int at[3]; // first node of the part, as seen from the brick that holds it
    int h[3];
    for (int a = 0; a < 3; ++a) {
      h[a] = axes >> a & 1 ? 0 : d[a];
      at[a] = part.first[a] - brick_cells * h[a];
    }
    const int holder = neighbors[offsetIndex(h[0], h[1], h[2])];
    if (holder < 0)
      continue;
    const float* rim = field.rim(level, holder, axes);
    const int step_y = rimIndex(axes, 0, 1, 0), step_z = rimIndex(axes, 0, 0, 1);
    return copyPart(part, rim ? rim + rimIndex(axes, at[0], at[1], at[2]) : nullptr, step_y, step_z, halo);
  }
  copyPart(part, nullptr, 0, 0, halo);
}
/// The part in the brick at an offset; unrolled, because the offset is known to the compiler.
template <int offset>
inline void loadPart(const BrickLevel& level, const Neighbors& neighbors, const NodeField& field, float* halo)
{
  constexpr int d[3] = {offset % 3 - 1, offset / 3 % 3 - 1, offset / 9 - 1};
  const int n = neighbors[offset];
  if (n < 0)
    return copyRim(level, neighbors, field, d, halo);
  constexpr HaloPart part = partAt(d);
  constexpr int first = ownIndex(part.first[0] & 3, part.first[1] & 3, part.first[2] & 3);
  copyPart(part, field.own(n) + first, brick_cells, brick_cells * brick_cells, halo);
}

template <int... offsets>
void loadParts(const BrickLevel& level, const Neighbors& neighbors, const NodeField& field, float* halo,
               std::integer_sequence<int, offsets...>)
{
  (loadPart<offsets>(level, neighbors, field, halo), ...);
}
} // namespace

void loadHalo(const BrickLevel& level, const Neighbors& neighbors, const NodeField& field, float* halo)
{
  loadParts(level, neighbors, field, halo, std::make_integer_sequence<int, 27>());
}

std::uint64_t fixedNodes(const Neighbors& neighbors)
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
  std::uint64_t fixed = 0;
  for (int o = 1; o < 8; ++o)
    if (neighbors[offsetIndex(-(o & 1), -(o >> 1 & 1), -(o >> 2))] < 0)
      fixed |= on_lower_faces[o];
  return fixed;
}
} // namespace fresco::poisson
