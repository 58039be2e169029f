// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/isosurface/small_components.h"
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

/// Faces of the components.
struct SizeRange {
  std::uint32_t least = std::numeric_limits<std::uint32_t>::max(), largest = 0;
};
} // namespace

Components::Components(const IsoSurface& surface, int threads)
    : sets_(surface.vertices.cols(), threads), faces_(surface.vertices.cols()), threads_(threads)
{
  parallelFor(surface.faces.cols(), threads, [&](Index f) {
    sets_.join(surface.faces(0, f), surface.faces(1, f));
    sets_.join(surface.faces(0, f), surface.faces(2, f));
  });
  parallelFor(surface.vertices.cols(), threads, [&](Index v) { setFaces(v, 0); });
  parallelRanges(surface.faces.cols(), threads, [&](Index begin, Index end) {
    Index root = sets_.root(surface.faces(0, begin));
    std::uint32_t count = 0; // most faces follow one of the same component
    for (Index f = begin; f < end; ++f) {
      const Index own = sets_.root(surface.faces(0, f));
      if (own != root)
        faces_[std::exchange(root, own)].fetch_add(std::exchange(count, 0), std::memory_order_relaxed);
      ++count;
    }
    faces_[root].fetch_add(count, std::memory_order_relaxed);
  });
}

bool Components::isSmallCount(std::uint32_t faces) const
{
  constexpr unsigned least_faces = 150; // of a ball four cells across: a ripple around a sample reaches no farther
  constexpr double least_share = 0.01;  // of the largest component's faces: a small scan may be all there is
  return faces < least_faces && faces < least_share * largest_;
}

bool Components::findSmall(Exchange& exchange)
{
  const auto map = [&](Index begin, Index end) {
    SizeRange sizes;
    for (Index v = begin; v < end; ++v)
      if (const std::uint32_t n = faces(v); n > 0)
        sizes = {std::min(sizes.least, n), std::max(sizes.largest, n)};
    return sizes;
  };
  const auto join = [](const SizeRange& a, const SizeRange& b) {
    return SizeRange{std::min(a.least, b.least), std::max(a.largest, b.largest)};
  };
  const SizeRange own = parallelReduce(Index(faces_.size()), threads_, SizeRange(), map, join);
  double sizes[2] = {-static_cast<double>(own.least), static_cast<double>(own.largest)};
  exchange.largest(sizes, 2);
  largest_ = sizes[1];
  return isSmallCount(static_cast<std::uint32_t>(-sizes[0]));
}

void removeSmallComponents(IsoSurface& surface, int threads)
{
  Components components(surface, threads);
  if (!components.findSmall(onlyRank()))
    return;
  Index kept = 0;
  for (Index f = 0; f < surface.faces.cols(); ++f)
    if (!components.isSmall(surface.faces(0, f)))
      surface.faces.col(kept++) = surface.faces.col(f).eval();
  surface.faces_backing = FileBacking();
  surface.faces.conservativeResize(3, kept);
  std::vector<int> new_index(surface.vertices.cols());
  int count = 0;
  for (const VertexRange& range : surface.ranges)
    for (Index v = range.first; v < range.first + range.count; ++v)
      new_index[v] = components.isSmall(v) ? -1 : count++;
  compactVertices(new_index, surface);
}
} // namespace fresco::poisson
