// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/isosurface/isosurface.h"
#include "poisson/isosurface/polygon.h"
#include "poisson/octree/halo.h"
#include "poisson/octree/select.h"
#include <algorithm>
#include <array>
#include <bitset>
#include <fresco/core/machine_memory.h>
#include <fresco/core/morton.h>
#include <fresco/core/parallel.h>
namespace fresco::poisson {
namespace {
/// One part is what a thread takes at a time: small enough for an even share, few enough to join quickly. As many bricks
/// as a chunk has yield tens of megabytes: arrays that a ScratchSpace takes.
constexpr Index bricks_per_part = 128, bricks_per_chunk = 1024 * bricks_per_part;

/// What one range of bricks yields; vertices < 0 are -1 - index into `extra`.
struct Part {
  Array<int> faces;
  Array<Eigen::Vector3f> extra;
  std::vector<VertexRange> extra_ranges;       ///< `first` counts within `extra`
  std::vector<KeyedRun> extra_runs, face_runs; ///< with several ranks, see OwnParts
};

class CellMarcher {
public:
  CellMarcher(const LevelSet& surface, const CrossedEdges& edges, const Points& positions)
      : surface_(surface), tree_(*surface.tree), edges_(edges), positions_(positions)
  {}

  void marchBrick(int depth, Index brick, Part& part)
  {
    const Index extra_before = part.extra.size();
    const int b = brick;
    (*surface_.chi)[depth].load(tree_.levels[depth], brick, nodes_);
    const NodeBits crossed = crossedCells();
    if (crossed.none())
      return;
    for (int z = 0; z < brick_cells; ++z)
      for (int y = 0; y < brick_cells; ++y)
        for (int x = 0; x < brick_cells; ++x)
          if (const CellPlace cell{depth, b, x, y, z};
              crossed[nodeIndex(x, y, z)] && childBrick(tree_, cell) < 0 && isOwn(cell)) {
            const Index faces = part.faces.size() / 3, extra = part.extra.size();
            marchCell(cell, part);
            if (tree_.partition)
              addRuns(cell, part.faces.size() / 3 - faces, part.extra.size() - extra, part);
          }
    if (const Index n = part.extra.size() - extra_before; n > 0)
      part.extra_ranges.push_back({depth, brick, extra_before, n});
  }

private:
  bool isOwn(const CellPlace& cell) const
  {
    if (!tree_.partition || tree_.isDivided(cell.depth)) // then the whole brick is
      return true;
    const auto [x, y, z] = tree_.levels[cell.depth].corner(cell.brick);
    return tree_.partition->owns(cell.depth, mortonCode(x + cell.x, y + cell.y, z + cell.z));
  }

  /// A brick two depths coarser than the shared one lies on several ranks: its cells are runs of their own.
  void addRuns(const CellPlace& cell, Index faces, Index extra, Part& part) const
  {
    const bool is_whole = cell.depth - 2 >= tree_.partition->atomDepth();
    const std::uint64_t number = std::uint64_t(cell.brick) * own_nodes + ownIndex(cell.x, cell.y, cell.z);
    const std::uint64_t key = OwnParts::keyOfDepth(cell.depth, is_whole ? tree_.partition->rank() : number);
    addToRuns(part.face_runs, key, faces);
    addToRuns(part.extra_runs, key, extra);
  }

  using NodeBits = std::bitset<nodes_per_brick>;

  /// By the nodeIndex() of their lowest corners: the cells of the marched brick that the surface passes through.
  NodeBits crossedCells() const
  {
    NodeBits some;
    for (int i = 0; i < nodes_per_brick; ++i)
      some[i] = surface_.inside(nodes_[i]);
    NodeBits all = some;
    for (const int step : {nodeIndex(1, 0, 0), nodeIndex(0, 1, 0), nodeIndex(0, 0, 1)}) {
      some |= some >> step;
      all &= all >> step;
    }
    return some & ~all;
  }

  void marchCell(const CellPlace& cell, Part& part)
  {
    polygons_.clear();
    edge_vertices_.fill(unknown);
    for (int face = 0; face < 6; ++face)
      if (const CellPlace beyond = refinedBeyond(cell, face); beyond.brick >= 0)
        addFace(beyond, face ^ 1, face, true);
      else
        addLeafFace(cell, face, face, false);
    polygons_.triangulate(positions_, part.faces, part.extra);
  }

  /// The neighbour across a face if it is refined, else brick = -1.
  CellPlace refinedBeyond(const CellPlace& cell, int face) const
  {
    CellPlace beyond = cell;
    beyond.brick = -1;
    if (cell.depth == tree_.depth)
      return beyond;
    beyond.brick = cell.brick;
    (face < 2 ? beyond.x : face < 4 ? beyond.y : beyond.z) += face & 1 ? 1 : -1;
    beyond = normalized(tree_, beyond);
    if (beyond.brick >= 0 && childBrick(tree_, beyond) < 0)
      beyond.brick = -1;
    return beyond;
  }

  /// Segments on a face of a cell or, where it is refined, of its children.
  /// @param owner_face face of the cell that is marched; `reversed` if that lies on the other side
  void addFace(const CellPlace& cell, int face, int owner_face, bool reversed)
  {
    const int child = childBrick(tree_, cell);
    if (child < 0) {
      addLeafFace(cell, face, owner_face, reversed);
      return;
    }
    for (int corner : face_corners[face])
      addFace({cell.depth + 1, child, 2 * (cell.x & 1) + (corner & 1), 2 * (cell.y & 1) + (corner >> 1 & 1),
               2 * (cell.z & 1) + (corner >> 2)},
              face, owner_face, reversed);
  }

  void addLeafFace(const CellPlace& cell, int face, int owner_face, bool reversed)
  {
    float chi[4];
    for (int k = 0; k < 4; ++k) {
      const int c = face_corners[face][k], x = cell.x + (c & 1), y = cell.y + (c >> 1 & 1), z = cell.z + (c >> 2);
      chi[k] = (reversed ? surface_.at(cell.depth, cell.brick, x, y, z) : nodes_[nodeIndex(x, y, z)]) - surface_.value;
    }
    const FaceCrossings crossings = crossFace(chi);
    for (int s = 0; s < crossings.count; ++s) {
      const int a = crossings.from[s], b = crossings.to[s];
      if (reversed)
        polygons_.add({vertexOnSide(cell, face, b), vertexOnSide(cell, face, a), owner_face});
      else
        polygons_.add({ownVertexOnSide(cell, face, a), ownVertexOnSide(cell, face, b), owner_face});
    }
  }

  int vertexOnSide(const CellPlace& cell, int face, int side) const
  {
    const int a = face_corners[face][side], b = face_corners[face][(side + 1) & 3];
    const int lower = a & b, axis = (a ^ b) >> 1;
    return edges_.vertexOn(
        {cell.depth, cell.brick, axis, cell.x + (lower & 1), cell.y + (lower >> 1 & 1), cell.z + (lower >> 2)});
  }

  /// The same of the cell that is marched: two of its faces share an edge.
  int ownVertexOnSide(const CellPlace& cell, int face, int side)
  {
    const int a = face_corners[face][side], b = face_corners[face][(side + 1) & 3];
    int& vertex = edge_vertices_[3 * (a & b) + ((a ^ b) >> 1)];
    if (vertex == unknown)
      vertex = vertexOnSide(cell, face, side);
    return vertex;
  }

  const LevelSet& surface_;
  const Octree& tree_;
  const CrossedEdges& edges_;
  const Points& positions_;
  CellPolygons polygons_;
  float nodes_[nodes_per_brick]; ///< chi in the brick that is marched
  static constexpr int unknown = -1;
  std::array<int, 24> edge_vertices_; ///< of the cell that is marched, by 3 x lower corner + axis of the edge
};

struct BrickPlace {
  int depth;
  Index brick;
};

std::vector<BrickPlace> bricksWithLeaves(const LevelSet& surface, int threads)
{
  std::vector<BrickPlace> bricks;
  for (int d = 2; d <= surface.tree->depth; ++d)
    for (const std::uint32_t b : selectIndices(surface.tree->levels[d].size(), threads, [&](Index brick) {
           return surface.tree->levels[d].owns(brick) && surface.hasLeaves(d, brick);
         }))
      bricks.push_back({d, b});
  return bricks;
}

/// Where a part begins in the joined arrays.
struct PartPlace {
  Index corner, vertex;
};

/// One place more than there are parts. @param vertex where the first one's `extra` begin
std::vector<PartPlace> placesOf(const std::vector<Part>& parts, Index vertex)
{
  std::vector<PartPlace> places(1, {0, vertex});
  for (const Part& part : parts)
    places.push_back(
        {places.back().corner + Index(part.faces.size()), places.back().vertex + Index(part.extra.size())});
  return places;
}

/// Copies the parts behind each other and frees them; number(v, place) is what becomes of a vertex < 0.
template <typename Number>
void copyParts(std::vector<Part>& parts, const std::vector<PartPlace>& places, int threads, int* faces,
               const Number& number)
{
  parallelFor(
      parts.size(), threads,
      [&](Index p) {
        std::transform(parts[p].faces.begin(), parts[p].faces.end(), faces + places[p].corner,
                       [&](int v) { return v >= 0 ? v : number(v, places[p]); });
        releaseMemory(parts[p].faces);
      },
      1);
}

Part joined(std::vector<Part>& parts, int threads)
{
  const std::vector<PartPlace> places = placesOf(parts, 0);
  Part chunk;
  chunk.faces.resize(places.back().corner);
  copyParts(parts, places, threads, chunk.faces.data(),
            [](int v, const PartPlace& place) { return v - static_cast<int>(place.vertex); });
  chunk.extra.reserve(places.back().vertex);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (VertexRange& range : parts[p].extra_ranges) {
      range.first += places[p].vertex;
      chunk.extra_ranges.push_back(range);
    }
    chunk.extra.insert(chunk.extra.end(), parts[p].extra.begin(), parts[p].extra.end());
    for (const KeyedRun& run : parts[p].face_runs)
      addToRuns(chunk.face_runs, run.key, run.count);
    for (const KeyedRun& run : parts[p].extra_runs)
      addToRuns(chunk.extra_runs, run.key, run.count);
  }
  return chunk;
}

/// Puts the chunks behind each other and frees them.
void join(std::vector<Part>& chunks, IsoSurface& surface, int threads)
{
  const Index vertices = surface.vertices.cols();
  const std::vector<PartPlace> places = placesOf(chunks, vertices);
  requireVertices(places.back().vertex);
  if (places.back().vertex > vertices) {
    Points all(3, places.back().vertex);
    FileBacking backing(all);
    all.leftCols(vertices) = surface.vertices;
    surface.vertices_backing = std::move(backing);
    surface.vertices.swap(all);
  }
  surface.faces.resize(3, places.back().corner / 3);
  surface.faces_backing = FileBacking(surface.faces);
  copyParts(chunks, places, threads, surface.faces.data(),
            [](int v, const PartPlace& place) { return static_cast<int>(place.vertex) - 1 - v; });
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    for (std::size_t i = 0; i < chunks[c].extra.size(); ++i)
      surface.vertices.col(places[c].vertex + Index(i)) = chunks[c].extra[i];
    for (VertexRange& range : chunks[c].extra_ranges) {
      range.first += places[c].vertex;
      surface.ranges.push_back(range);
    }
  }
}
/// Sets the vertices on edges. @returns the faces, in chunks of bricks
std::vector<Part> marchLeaves(const LevelSet& surface, int threads, IsoSurface& result, OwnParts& own)
{
  const CrossedEdges edges(surface, threads);
  result.vertices.resize(3, edges.vertexCount());
  result.vertices_backing = FileBacking(result.vertices);
  edges.fillPositions(threads, result.vertices);
  edges.forEachBrick([&](int depth, Index brick, Index first, Index count) {
    result.ranges.push_back({depth, brick, first, count});
  });
  const std::vector<BrickPlace> bricks = bricksWithLeaves(surface, threads);
  const Index n = bricks.size();
  std::vector<Part> chunks;
  for (Index from = 0; from < n; from += bricks_per_chunk) {
    const Index count = std::min(bricks_per_chunk, n - from);
    std::vector<Part> parts((count + bricks_per_part - 1) / bricks_per_part);
    parallelRanges(
        count, threads,
        [&](Index begin, Index end) {
          CellMarcher marcher(surface, edges, result.vertices);
          for (Index i = from + begin; i < from + end; ++i)
            marcher.marchBrick(bricks[i].depth, bricks[i].brick, parts[begin / bricks_per_part]);
        },
        bricks_per_part);
    chunks.push_back(joined(parts, threads));
    for (const KeyedRun& run : chunks.back().face_runs)
      addToRuns(own.faces, run.key, run.count);
    for (const KeyedRun& run : chunks.back().extra_runs)
      addToRuns(own.extras, run.key, run.count);
  }
  own.edge_vertices = edges.vertexCount();
  return chunks;
}
} // namespace

IsoSurface extractIsoSurface(const Octree& tree, std::vector<NodeField>&& chi, float value, int threads)
{
  OwnParts all;
  return extractIsoSurface(tree, std::move(chi), value, threads, all);
}

IsoSurface extractIsoSurface(const Octree& tree, std::vector<NodeField>&& chi, float value, int threads, OwnParts& own)
{
  IsoSurface result;
  std::vector<NodeField> values = std::move(chi);
  std::vector<Part> chunks = marchLeaves({&tree, &values, value}, threads, result, own);
  releaseMemory(values);
  join(chunks, result, threads);
  return result;
}
} // namespace fresco::poisson
