// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/ranks/surface_part.h"
#include "poisson/isosurface/small_components.h"
#include <algorithm>
#include <array>
#include <fresco/core/parallel.h>
#include <fresco/core/union_find.h>
namespace fresco::poisson {
namespace {
constexpr std::uint64_t behind_edges = std::uint64_t(1) << 62; ///< in the key of a run

/// Vertices of a rank: its own, and those on edges of ghosts and of shared depths, which are other ranks'.
class RankVertices {
public:
  RankVertices(const Octree& tree, const IsoSurface& surface, const OwnParts& own)
      : tree_(tree), owners_(surface.vertices.cols(), tree.partition->rank()), numbers_(own.edge_vertices)
  {
    for (const VertexRange& range : surface.ranges)
      if (range.first < own.edge_vertices)
        addRange(range);
    Index begin = own.edge_vertices;
    for (const KeyedRun& run : own.extras) {
      begins_.push_back(begin);
      runs_.push_back({run.key | behind_edges, run.count});
      begin += run.count;
    }
    numberEdges(surface, own.edge_vertices);
  }

  /// Own runs, and where they begin here.
  const std::vector<KeyedRun>& runs() const { return runs_; }
  Index begin(std::size_t run) const { return begins_[run]; }

  int ownerOf(Index v) const { return owners_[v]; }
  bool isOwn(Index v) const { return owners_[v] == tree_.partition->rank(); }
  /// By which the ranks name vertices on edges to each other.
  std::int64_t numberOf(Index v) const { return numbers_[v]; }
  /// Own vertex of that name.
  Index ownVertex(std::int64_t number) const
  {
    const auto run =
        std::upper_bound(first_numbers_.begin(), first_numbers_.end(), number) - first_numbers_.begin() - 1;
    return begins_[run] + (number - first_numbers_[run]);
  }

private:
  void addRange(const VertexRange& range)
  {
    const Partition& partition = *tree_.partition;
    const int owner = tree_.isDivided(range.depth)
                          ? partition.ownerOf(range.depth - 2, tree_.levels[range.depth].codes[range.brick])
                          : 0;
    std::fill_n(owners_.begin() + range.first, range.count, owner);
    if (owner != partition.rank())
      return;
    const std::uint64_t key = OwnParts::keyOfDepth(range.depth, owner);
    if (runs_.empty() || runs_.back().key != key)
      begins_.push_back(range.first);
    addToRuns(runs_, key, range.count);
  }

  /// Those of shared depths are the first, and have the same numbers on all ranks.
  void numberEdges(const IsoSurface& surface, Index edge_vertices)
  {
    first_numbers_ = placeRuns(tree_.exchange(), runs_).first;
    std::vector<std::vector<Index>> of_brick(tree_.levels.size());
    for (const BrickLevel& level : tree_.levels)
      of_brick[level.depth].resize(level.ghosts.isDivided() ? level.codes.size() : 0);
    std::size_t run = 0;
    forEachDividedRange(surface, edge_vertices, [&](const VertexRange& range) {
      if (owners_[range.first] != tree_.partition->rank())
        return;
      while (range.first >= begins_[run] + runs_[run].count)
        ++run;
      of_brick[range.depth][range.brick] = first_numbers_[run] + (range.first - begins_[run]);
    });
    for (const BrickLevel& level : tree_.levels)
      level.ghosts.refresh(of_brick[level.depth].data());
    for (Index v = 0; v < edge_vertices; ++v)
      numbers_[v] = v;
    forEachDividedRange(surface, edge_vertices, [&](const VertexRange& range) {
      for (Index i = 0; i < range.count; ++i)
        numbers_[range.first + i] = of_brick[range.depth][range.brick] + i;
    });
  }

  template <typename Visit>
  void forEachDividedRange(const IsoSurface& surface, Index edge_vertices, const Visit& visit) const
  {
    for (const VertexRange& range : surface.ranges)
      if (range.first < edge_vertices && tree_.isDivided(range.depth))
        visit(range);
  }

  const Octree& tree_;
  std::vector<int> owners_;
  Array<std::int64_t> numbers_;
  std::vector<KeyedRun> runs_;
  std::vector<Index> begins_, first_numbers_;
};

/// Which vertices that own faces use are other ranks', and which own ones other ranks' faces use.
class BorrowedVertices {
public:
  BorrowedVertices(const RankVertices& vertices, const IsoSurface& surface, Exchange& exchange)
      : exchange_(exchange), borrowed(exchange.size()), lent(exchange.size())
  {
    std::vector<char> found(surface.vertices.cols(), 0);
    for (Index c = 0; c < surface.faces.size(); ++c)
      if (const int v = surface.faces.data()[c]; vertices.ownerOf(v) != exchange.rank() && !found[v]) {
        found[v] = 1;
        borrowed[vertices.ownerOf(v)].push_back(v);
      }
    std::vector<Bytes> numbers(exchange.size());
    for (int r = 0; r < exchange.size(); ++r)
      for (const int v : borrowed[r])
        append(numbers[r], vertices.numberOf(v));
    const std::vector<Bytes> asked = exchange.deliver(std::move(numbers));
    for (int r = 0; r < exchange.size(); ++r)
      for (const std::int64_t number : valuesOf<std::int64_t>(asked[r]))
        lent[r].push_back(vertices.ownVertex(number));
  }

  /// What the borrowers say of each lent vertex: valueOf(borrowed vertex), by rank as `lent`.
  template <typename Value>
  std::vector<Bytes> tellLenders(const Value& value_of) const
  {
    return tell(borrowed, value_of);
  }
  /// What the lenders say of each borrowed vertex.
  template <typename Value>
  std::vector<Bytes> tellBorrowers(const Value& value_of) const
  {
    return tell(lent, value_of);
  }

private:
  template <typename Value>
  std::vector<Bytes> tell(const std::vector<std::vector<int>>& lists, const Value& value_of) const
  {
    std::vector<Bytes> to(lists.size());
    for (std::size_t r = 0; r < lists.size(); ++r)
      for (const int v : lists[r])
        append(to[r], value_of(v));
    return exchange_.deliver(std::move(to));
  }

  Exchange& exchange_;

public:
  std::vector<std::vector<int>> borrowed, lent; ///< by the other rank
};

/// Adds up the faces of components that lie on several ranks.
void joinAcrossRanks(const BorrowedVertices& shared, Exchange& exchange, Components& components)
{
  const auto name = [](int rank, std::uint32_t root) { return std::uint64_t(rank) << 32 | root; };
  const std::vector<Bytes> told = shared.tellLenders([&](int v) { return components.rootOf(v); });
  using Link = std::array<std::uint64_t, 2>;
  std::vector<Link> links;
  for (int r = 0; r < exchange.size(); ++r) {
    const Array<std::uint32_t> roots = valuesOf<std::uint32_t>(told[r]);
    for (std::size_t i = 0; i < roots.size(); ++i)
      links.push_back({name(exchange.rank(), components.rootOf(shared.lent[r][i])), name(r, roots[i])});
  }
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  const Array<Link> all = gatherAll(exchange, links.data(), links.size());
  std::vector<std::uint64_t> names;
  for (const Link& link : all)
    names.insert(names.end(), link.begin(), link.end());
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  const auto placeOf = [&](std::uint64_t n) { return std::lower_bound(names.begin(), names.end(), n) - names.begin(); };
  UnionFind sets(names.size());
  for (const Link& link : all)
    sets.join(placeOf(link[0]), placeOf(link[1]));
  std::vector<std::int64_t> faces(names.size(), 0);
  const auto isOwn = [&](std::size_t i) { return names[i] >> 32 == std::uint64_t(exchange.rank()); };
  for (std::size_t i = 0; i < names.size(); ++i)
    if (isOwn(i))
      faces[sets.root(i)] += components.faces(names[i] & 0xffffffffU);
  exchange.sum(faces.data(), faces.size());
  for (std::size_t i = 0; i < names.size(); ++i)
    if (isOwn(i))
      components.setFaces(names[i] & 0xffffffffU, faces[sets.root(i)]);
}

/// Runs of what is kept, as it lies here and in the whole.
struct KeptRuns {
  std::vector<KeyedRun> runs;
  PlacedRuns placed;

  std::vector<VolumetricPart::Run> toRuns() const
  {
    std::vector<VolumetricPart::Run> result;
    for (std::size_t r = 0; r < runs.size(); ++r)
      if (!result.empty() && result.back().first + result.back().count == placed.first[r])
        result.back().count += runs[r].count;
      else
        result.push_back({placed.first[r], runs[r].count});
    return result;
  }
};

/// @param begin where a run begins. @param is_kept of an element
template <typename Begin, typename IsKept>
KeptRuns keptRuns(const std::vector<KeyedRun>& runs, Exchange& exchange, const Begin& begin, const IsKept& is_kept)
{
  KeptRuns kept;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    Index count = 0;
    for (Index i = begin(r); i < begin(r) + runs[r].count; ++i)
      count += is_kept(i) ? 1 : 0;
    addToRuns(kept.runs, runs[r].key, count);
  }
  kept.placed = placeRuns(exchange, kept.runs);
  return kept;
}

/// Own vertices that are kept, and their ranges.
void takeVertices(const IsoSurface& all, const std::vector<int>& numbers, const RankVertices& vertices, IsoSurface& own)
{
  const auto isTaken = [&](Index v) { return numbers[v] >= 0 && vertices.isOwn(v); };
  Index count = 0;
  for (const VertexRange& range : all.ranges) {
    VertexRange taken{range.depth, range.brick, count, 0};
    for (Index v = range.first; v < range.first + range.count; ++v)
      count += isTaken(v) ? 1 : 0;
    taken.count = count - taken.first;
    if (taken.count > 0)
      own.ranges.push_back(taken);
  }
  own.vertices.resize(3, count);
  own.vertices_backing = FileBacking(own.vertices);
  Index at = 0;
  for (Index v = 0; v < all.vertices.cols(); ++v)
    if (isTaken(v))
      own.vertices.col(at++) = all.vertices.col(v);
}

/// Numbers in the whole of own vertices and of borrowed ones; -1 of those that go.
std::vector<int> numbersOf(const RankVertices& vertices, const KeptRuns& kept, const Components& components,
                           const BorrowedVertices& shared, Index count)
{
  std::vector<int> numbers(count, -1);
  std::size_t place = 0;
  for (std::size_t r = 0; r < vertices.runs().size(); ++r) {
    Index number = -1;
    const KeyedRun& run = vertices.runs()[r];
    if (place < kept.runs.size() && kept.runs[place].key == run.key)
      number = kept.placed.first[place++];
    for (Index v = vertices.begin(r); v < vertices.begin(r) + run.count; ++v)
      if (!components.isSmall(v))
        numbers[v] = static_cast<int>(number++);
  }
  const std::vector<Bytes> told = shared.tellBorrowers([&](int v) { return numbers[v]; });
  for (std::size_t r = 0; r < told.size(); ++r) {
    const Array<int> theirs = valuesOf<int>(told[r]);
    for (std::size_t i = 0; i < theirs.size(); ++i)
      numbers[shared.borrowed[r][i]] = theirs[i];
  }
  return numbers;
}
} // namespace

SurfacePart extractSurfacePart(const Octree& tree, std::vector<NodeField>&& chi, float level_set, int threads)
{
  Exchange& exchange = tree.exchange();
  OwnParts own;
  IsoSurface all = extractIsoSurface(tree, std::move(chi), level_set, threads, own);
  const RankVertices vertices(tree, all, own);
  const BorrowedVertices shared(vertices, all, exchange);
  Components components(all, threads);
  joinAcrossRanks(shared, exchange, components);
  components.findSmall(exchange);
  const KeptRuns kept = keptRuns(
      vertices.runs(), exchange, [&](std::size_t r) { return vertices.begin(r); },
      [&](Index v) { return !components.isSmall(v); });
  requireVertices(kept.placed.count);
  const std::vector<int> numbers = numbersOf(vertices, kept, components, shared, all.vertices.cols());
  std::vector<Index> begins;
  Index faces = 0;
  for (const KeyedRun& run : own.faces) {
    begins.push_back(faces);
    faces += run.count;
  }
  const auto isKept = [&](Index f) { return numbers[all.faces(0, f)] >= 0; };
  const KeptRuns kept_faces = keptRuns(
      own.faces, exchange, [&](std::size_t r) { return begins[r]; }, isKept);
  SurfacePart part;
  part.vertices = kept.toRuns();
  part.faces = kept_faces.toRuns();
  part.vertex_count = kept.placed.count;
  part.face_count = kept_faces.placed.count;
  takeVertices(all, numbers, vertices, part.surface);
  Index at = 0;
  for (Index f = 0; f < all.faces.cols(); ++f)
    if (isKept(f)) {
      for (int k = 0; k < 3; ++k)
        all.faces(k, at) = numbers[all.faces(k, f)];
      ++at;
    }
  all.faces_backing = FileBacking();
  all.faces.conservativeResize(3, at);
  part.surface.faces.swap(all.faces);
  return part;
}
} // namespace fresco::poisson
