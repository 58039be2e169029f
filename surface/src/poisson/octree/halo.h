// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/node_field.h"
#include <cstdint>
namespace fresco::poisson {
/// Nodes -1..4 of a brick on each axis, its own (0..3) and those around it: floats a row (padded to two vectors), a
/// slice, in all.
constexpr int halo_row = 8, halo_slice = 6 * halo_row, halo_size = 6 * halo_slice;

constexpr int haloIndex(int x, int y, int z) { return (x + 1) + halo_row * (y + 1) + halo_slice * (z + 1); }
/// From a node to its neighbour `o` of offsetIndex().
constexpr int haloStep(int o) { return (o % 3 - 1) + halo_row * (o / 3 % 3 - 1) + halo_slice * (o / 9 - 1); }

/// Number of axes on which a node and its neighbour `o` of offsetIndex() differ.
constexpr int axesOf(int o) { return (o % 3 != 1) + (o / 3 % 3 != 1) + (o / 9 != 1); }

/// Four nodes in a row along x, at any address.
using Line [[gnu::vector_size(16), gnu::aligned(4), gnu::may_alias]] = float;
inline Line& line(float* p) { return *reinterpret_cast<Line*>(p); }
inline const Line& line(const float* p) { return *reinterpret_cast<const Line*>(p); }

/// Values of the nodes in and around a brick; 0 where no brick holds a node.
/// @param neighbors of the brick. @param halo halo_size floats
void loadHalo(const BrickLevel& level, const Neighbors& neighbors, const NodeField& field, float* halo);

/// Bit ownIndex(): the node has a missing cell around it, so its value comes from the coarser depth.
std::uint64_t fixedNodes(const Neighbors& neighbors);
} // namespace fresco::poisson
