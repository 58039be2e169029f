// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/small_components.h"
#include <algorithm>
#include <fresco/core/union_find.h>
#include <limits>
#include <utility>
namespace fresco::poisson {
namespace {
void compactVertices(const std::vector<int>& new_index, IsoSurface& surface)
{
  Index count = 0;
  for (VertexRange& range : surface.ranges) {
    const Index first = count;
    for (Index v = range.first; v < range.first + range.count; ++v)
      if (new_index[v] >= 0)
        surface.vertices.col(count++) = surface.vertices.col(v).eval();
    range.first = first;
    range.count = count - first;
  }
  surface.vertices_backing = FileBacking();
  surface.vertices.conservativeResize(3, count);
  for (Index f = 0; f < surface.faces.cols(); ++f)
    for (int k = 0; k < 3; ++k)
      surface.faces(k, f) = new_index[surface.faces(k, f)];
}
using Counter = std::atomic<std::uint32_t>;

/// Number of faces of each component, at its lowest vertex.
Array<Counter> facesByRoot(const IsoSurface& surface, ConcurrentUnionFind& components, int threads)
{
  Array<Counter> faces(surface.vertices.cols());
  parallelFor(surface.vertices.cols(), threads, [&](Index v) { faces[v].store(0, std::memory_order_relaxed); });
  parallelRanges(surface.faces.cols(), threads, [&](Index begin, Index end) {
    Index root = components.root(surface.faces(0, begin));
    std::uint32_t count = 0; // most faces follow one of the same component
    for (Index f = begin; f < end; ++f) {
      const Index own = components.root(surface.faces(0, f));
      if (own != root)
        faces[std::exchange(root, own)].fetch_add(std::exchange(count, 0), std::memory_order_relaxed);
      ++count;
    }
    faces[root].fetch_add(count, std::memory_order_relaxed);
  });
  return faces;
}

/// Faces of the components.
struct SizeRange {
  std::uint32_t least = std::numeric_limits<std::uint32_t>::max(), largest = 0;
};
} // namespace

void removeSmallComponents(IsoSurface& surface, int threads)
{
  constexpr unsigned least_faces = 150; // of a ball four cells across: a ripple around a sample reaches no farther
  constexpr double least_share = 0.01;  // of the largest component's faces: a small scan may be all there is
  ConcurrentUnionFind components(surface.vertices.cols(), threads);
  parallelFor(surface.faces.cols(), threads, [&](Index f) {
    components.join(surface.faces(0, f), surface.faces(1, f));
    components.join(surface.faces(0, f), surface.faces(2, f));
  });
  const Array<Counter> faces = facesByRoot(surface, components, threads);
  const auto numberOf = [&](Index v) { return faces[v].load(std::memory_order_relaxed); };
  const auto map = [&](Index begin, Index end) {
    SizeRange sizes;
    for (Index v = begin; v < end; ++v)
      if (const std::uint32_t n = numberOf(v); n > 0)
        sizes = {std::min(sizes.least, n), std::max(sizes.largest, n)};
    return sizes;
  };
  const auto join = [](const SizeRange& a, const SizeRange& b) {
    return SizeRange{std::min(a.least, b.least), std::max(a.largest, b.largest)};
  };
  const Index vertices = surface.vertices.cols();
  const SizeRange sizes = parallelReduce(vertices, threads, SizeRange(), map, join);
  const auto isSmall = [&](std::uint32_t n) { return n < least_faces && n < least_share * sizes.largest; };
  if (!isSmall(sizes.least))
    return;
  const auto isRemoved = [&](Index v) { return isSmall(numberOf(components.root(v))); };
  Index kept = 0;
  for (Index f = 0; f < surface.faces.cols(); ++f)
    if (!isRemoved(surface.faces(0, f)))
      surface.faces.col(kept++) = surface.faces.col(f).eval();
  surface.faces_backing = FileBacking();
  surface.faces.conservativeResize(3, kept);
  std::vector<int> new_index(vertices);
  int count = 0;
  for (const VertexRange& range : surface.ranges)
    for (Index v = range.first; v < range.first + range.count; ++v)
      new_index[v] = isRemoved(v) ? -1 : count++;
  compactVertices(new_index, surface);
}
} // namespace fresco::poisson
