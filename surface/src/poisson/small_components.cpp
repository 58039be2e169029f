// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/small_components.h"
#include <algorithm>
#include <fresco/core/union_find.h>
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
  surface.vertices.conservativeResize(3, count);
  for (Index f = 0; f < surface.faces.cols(); ++f)
    for (int k = 0; k < 3; ++k)
      surface.faces(k, f) = new_index[surface.faces(k, f)];
}
} // namespace

void removeSmallComponents(IsoSurface& surface)
{
  constexpr int least_faces = 150;     // of a ball four cells across: a ripple around a sample reaches no farther
  constexpr double least_share = 0.01; // of the largest component's faces: a small scan may be all there is
  UnionFind components(surface.vertices.cols());
  for (Index f = 0; f < surface.faces.cols(); ++f) {
    components.join(surface.faces(0, f), surface.faces(1, f));
    components.join(surface.faces(0, f), surface.faces(2, f));
  }
  std::vector<int> faces(surface.vertices.cols(), 0); // by root
  for (Index f = 0; f < surface.faces.cols(); ++f)
    ++faces[components.root(surface.faces(0, f))];
  const int largest = faces.empty() ? 0 : *std::max_element(faces.begin(), faces.end());
  const auto isSmall = [&](int n) { return n < least_faces && n < least_share * largest; };
  if (std::none_of(faces.begin(), faces.end(), [&](int n) { return n > 0 && isSmall(n); }))
    return;
  const auto isRemoved = [&](Index v) { return isSmall(faces[components.root(v)]); };
  Index kept = 0;
  for (Index f = 0; f < surface.faces.cols(); ++f)
    if (!isRemoved(surface.faces(0, f)))
      surface.faces.col(kept++) = surface.faces.col(f).eval();
  surface.faces.conservativeResize(3, kept);
  std::vector<int> new_index(faces.size());
  int count = 0;
  for (const VertexRange& range : surface.ranges)
    for (Index v = range.first; v < range.first + range.count; ++v)
      new_index[v] = isRemoved(v) ? -1 : count++;
  compactVertices(new_index, surface);
}
} // namespace fresco::poisson
