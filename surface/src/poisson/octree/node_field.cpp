// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/octree/node_field.h"
#include "poisson/octree/bytes.h"
#include "poisson/octree/select.h"
#include <algorithm>
#include <cstring>
#include <fresco/core/machine_memory.h>
#include <fresco/core/parallel.h>
#include <limits>
#include <utility>
namespace fresco::poisson {
namespace {
/// A node on an upper face: among those of its brick, and of the neighbour whose own it is.
struct UpperNode {
  std::uint8_t node, own;
};

/// Nodes by upperAxes(), in the order of rimIndex().
struct UpperNodes {
  std::array<std::array<UpperNode, brick_cells * brick_cells>, 8> of{};
  std::array<int, 8> count{};
};

constexpr UpperNodes upperNodes()
{
  UpperNodes nodes;
  for (int z = 0; z < brick_nodes; ++z)
    for (int y = 0; y < brick_nodes; ++y)
      for (int x = 0; x < brick_nodes; ++x)
        if (const int axes = upperAxes(x, y, z); axes > 0)
          nodes.of[axes][nodes.count[axes]++] = {static_cast<std::uint8_t>(nodeIndex(x, y, z)),
                                                 static_cast<std::uint8_t>(ownIndex(x & 3, y & 3, z & 3))};
  return nodes;
}

constexpr UpperNodes upper = upperNodes();

/// First node of each part, and their number at 0, by Rim::parts.
using PartPlaces = std::array<std::array<std::uint8_t, 8>, 256>;

constexpr PartPlaces partPlaces()
{
  PartPlaces places{};
  for (int parts = 0; parts < 256; ++parts) {
    int count = 0;
    for (int axes = 1; axes < 8; ++axes) {
      places[parts][axes] = static_cast<std::uint8_t>(count);
      count += parts >> axes & 1 ? upper.count[axes] : 0;
    }
    places[parts][0] = static_cast<std::uint8_t>(count);
  }
  return places;
}

constexpr PartPlaces part_places = partPlaces();

/// visit(i, node) for the nodes of a brick's rim and their place in it.
template <typename Visit>
void forEachRimNode(unsigned parts, const Visit& visit)
{
  int at = 0;
  for (int axes = 1; axes < 8; ++axes)
    for (int i = 0; parts >> axes & 1 && i < upper.count[axes]; ++i)
      visit(at++, upper.of[axes][i].node);
}

/// visit(own node, node) for the first of each row of four.
template <typename Visit>
void forEachRow(const Visit& visit)
{
  for (int z = 0; z < brick_cells; ++z)
    for (int y = 0; y < brick_cells; ++y)
      visit(ownIndex(0, y, z), nodeIndex(0, y, z));
}
} // namespace

int rimPart(unsigned parts, int axes) { return part_places[parts][axes]; }

void copyUpperNodes(const float* nodes, float* upper)
{
  forEachRimNode(0xff, [&](int i, int node) { upper[i] = nodes[node]; });
}

void findRims(BrickLevel& level, int threads)
{
  level.rims.resize(level.codes.size());
  std::vector<Index> first((level.codes.size() + chunk_size - 1) / chunk_size);
  parallelRanges(
      level.size(), threads,
      [&](Index begin, Index end) {
        for (Index b = begin; b < end; ++b) {
          const Neighbors neighbors = level.neighborsOf(b);
          unsigned parts = 0;
          for (int axes = 1; axes < 8; ++axes)
            parts |= (neighbors[upperOffset(axes)] < 0 ? 1u : 0u) << axes;
          level.rims[b].parts = parts;
          first[begin / chunk_size] += part_places[parts][0];
        }
      },
      chunk_size);
  for (Index& f : first)
    f = std::exchange(level.rim_nodes, level.rim_nodes + f);
  parallelRanges(
      level.size(), threads,
      [&](Index begin, Index end) {
        Index at = first[begin / chunk_size];
        for (Index b = begin; b < end; at += part_places[level.rims[b++].parts][0])
          level.rims[b].first = at;
      },
      chunk_size);
}

void NodeField::clear(int threads)
{
  for (Array<float>* part : {&own_, &rim_})
    parallelRanges(part->size(), threads, [&](Index begin, Index end) {
      std::memset(part->data() + begin, 0, (end - begin) * sizeof(float));
    });
}

NodeField NodeField::copy(int threads) const
{
  NodeField result;
  result.size_ = size_;
  for (const auto& [from, to] : {std::pair(&own_, &result.own_), std::pair(&rim_, &result.rim_)}) {
    to->resize(from->size());
    parallelRanges(from->size(), threads, [from = from, to = to](Index begin, Index end) {
      std::copy(from->begin() + begin, from->begin() + end, to->begin() + begin);
    });
  }
  return result;
}

void NodeField::releaseRim() { releaseMemory(rim_); }

float NodeField::value(const BrickLevel& level, Index b, int x, int y, int z) const
{
  const int axes = upperAxes(x, y, z);
  if (axes == 0)
    return own(b)[ownIndex(x, y, z)];
  if (level.rims[b].parts >> axes & 1)
    return rim(level, b, axes)[rimIndex(axes, x, y, z)];
  return own(level.neighbor(b, upperOffset(axes)))[ownIndex(x & 3, y & 3, z & 3)];
}

void NodeField::load(const BrickLevel& level, Index b, float* nodes) const
{
  forEachRow([&](int own_node, int node) { std::copy_n(own(b) + own_node, brick_cells, nodes + node); });
  for (int axes = 1; axes < 8; ++axes) {
    const int count = upper.count[axes];
    const auto& place = upper.of[axes];
    if (level.rims[b].parts >> axes & 1) {
      const float* from = rim(level, b, axes);
      for (int i = 0; i < count; ++i)
        nodes[place[i].node] = from[i];
    } else {
      const float* from = own(level.neighbor(b, upperOffset(axes)));
      for (int i = 0; i < count; ++i)
        nodes[place[i].node] = from[place[i].own];
    }
  }
}

void NodeField::loadHeld(const BrickLevel& level, Index b, float* nodes) const
{
  std::fill_n(nodes, nodes_per_brick, 0.f);
  forEachRow([&](int own_node, int node) { std::copy_n(own(b) + own_node, brick_cells, nodes + node); });
  const float* from = rim_.data() + level.rims[b].first;
  forEachRimNode(level.rims[b].parts, [&](int i, int node) { nodes[node] = from[i]; });
}

void NodeField::store(const BrickLevel& level, Index b, const float* nodes)
{
  forEachRow([&](int own_node, int node) { std::copy_n(nodes + node, brick_cells, own(b) + own_node); });
  float* to = rim_.data() + level.rims[b].first;
  forEachRimNode(level.rims[b].parts, [&](int i, int node) { to[i] = nodes[node]; });
}

void NodeField::add(const BrickLevel& level, Index b, float factor, const float* nodes)
{
  forEachRow([&](int own_node, int node) {
    for (int x = 0; x < brick_cells; ++x)
      own(b)[own_node + x] += factor * nodes[node + x];
  });
  if (rim_.empty())
    return;
  float* to = rim_.data() + level.rims[b].first;
  forEachRimNode(level.rims[b].parts, [&](int i, int node) { to[i] += factor * nodes[node]; });
}

void poisonGhosts(const BrickLevel& level, NodeField& field, int color)
{
  if (!Ghosts::poison || !level.ghosts.isDivided())
    return;
  for (const Ghosts::Peer& peer : level.ghosts.peers)
    for (const int b : peer.receive.bricks)
      if (color < 0 || static_cast<int>(level.codes[b] >> 6 & 7) == color)
        std::fill_n(field.own(b), own_nodes, std::numeric_limits<float>::quiet_NaN());
}

void refreshOwnNodes(const BrickLevel& level, NodeField& field, int color)
{
  constexpr std::size_t bytes = own_nodes * sizeof(float);
  poisonGhosts(level, field, color);
  level.ghosts.swap(
      bytes, [&](int b, std::byte* message) { std::memcpy(message, field.own(b), bytes); },
      [&](int b, const std::byte* message) { std::memcpy(field.own(b), message, bytes); }, color);
}

/// Own nodes first: those on the upper faces of a brick may be a third rank's.
void refreshGhosts(const BrickLevel& level, NodeField& field)
{
  refreshOwnNodes(level, field);
  using Nodes = std::array<float, nodes_per_brick>;
  Nodes nodes;
  level.ghosts.swap(
      sizeof(nodes),
      [&](int b, std::byte* message) {
        field.load(level, b, nodes.data());
        std::memcpy(message, nodes.data(), sizeof(nodes));
      },
      [&](int b, const std::byte* message) {
        std::memcpy(nodes.data(), message, sizeof(nodes));
        field.store(level, b, nodes.data());
      });
}

void broadcastNodes(Exchange& exchange, const BrickLevel& level, NodeField& field)
{
  using Nodes = std::array<float, nodes_per_brick>;
  std::vector<Nodes> bricks(level.codes.size());
  if (exchange.rank() == 0)
    for (Index b = 0; b < level.size(); ++b)
      field.load(level, b, bricks[b].data());
  broadcast(exchange, bricks.data(), bricks.size());
  field = NodeField(level);
  for (Index b = 0; b < level.size(); ++b)
    field.store(level, b, bricks[b].data());
}

NodePlace findNodeAround(const BrickLevel& level, Index b, int x, int y, int z)
{
  const int ox = x >> 2, oy = y >> 2, oz = z >> 2;
  const int owner = level.neighbor(b, offsetIndex(ox, oy, oz));
  if (owner >= 0)
    return {Index(owner) * own_nodes + ownIndex(x & 3, y & 3, z & 3), -1};
  const int mx = std::min(ox, (x - 1) >> 2), my = std::min(oy, (y - 1) >> 2), mz = std::min(oz, (z - 1) >> 2);
  for (int m = 1; m < 8; ++m) { // the other bricks that touch the node
    const int px = m & 1 ? mx : ox, py = m & 2 ? my : oy, pz = m & 4 ? mz : oz;
    if (px < -1 || py < -1 || pz < -1)
      continue;
    const int holder = level.neighbor(b, offsetIndex(px, py, pz));
    if (holder < 0)
      continue;
    const int hx = x - 4 * px, hy = y - 4 * py, hz = z - 4 * pz, axes = upperAxes(hx, hy, hz);
    const Rim rim = level.rims[holder];
    return {-1, Index(rim.first) + rimPart(rim.parts, axes) + rimIndex(axes, hx, hy, hz)};
  }
  return {};
}
} // namespace fresco::poisson
