// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/select.h"
#include <algorithm>
#include <fresco/core/parallel.h>
#include <fresco/core/types.h>
#include <vector>
namespace fresco::poisson {
/// Goes through the corners of all faces so that each vertex is one thread's: sums at the vertices need no locks, and
/// have the order of the faces. Fast where neighbouring faces have neighbouring vertices.
class CornersByVertex {
public:
  CornersByVertex(const Faces& faces, Index vertices, int threads) : faces_(faces), threads_(threads)
  {
    constexpr Index ranges_a_thread = 4; // for an even share; each looks at all faces of the chunks that it has part in
    ranges_ = ranges_a_thread * threadCount(threads);
    vertices_ = std::max<Index>(1, (vertices + ranges_ - 1) / ranges_);
    std::vector<std::vector<Index>> ranges_of_chunk((faces.cols() + chunk_size - 1) / chunk_size);
    parallelRanges(
        faces.cols(), threads,
        [&](Index begin, Index end) { ranges_of_chunk[begin / chunk_size] = rangesOf(begin, end); }, chunk_size);
    chunks_of_range_.resize(ranges_);
    for (std::size_t c = 0; c < ranges_of_chunk.size(); ++c)
      for (const Index range : ranges_of_chunk[c])
        chunks_of_range_[range].push_back(c);
  }

  /// visit(vertex, face, corner 0..2), per vertex in the order of the faces.
  template <typename Visit>
  void forEach(const Visit& visit) const
  {
    parallelFor(
        ranges_, threads_,
        [&](Index range) {
          for (const Index c : chunks_of_range_[range])
            for (Index f = c * chunk_size; f < std::min(faces_.cols(), (c + 1) * chunk_size); ++f)
              for (int k = 0; k < 3; ++k)
                if (const Index v = faces_(k, f); v >= range * vertices_ && v < (range + 1) * vertices_)
                  visit(v, f, k);
        },
        1);
  }

private:
  std::vector<Index> rangesOf(Index begin, Index end) const
  {
    std::vector<char> used(ranges_, 0);
    for (Index f = begin; f < end; ++f)
      for (int k = 0; k < 3; ++k)
        used[faces_(k, f) / vertices_] = 1;
    std::vector<Index> ranges;
    for (Index range = 0; range < ranges_; ++range)
      if (used[range])
        ranges.push_back(range);
    return ranges;
  }

  const Faces& faces_;
  int threads_;
  Index ranges_, vertices_; ///< number, and vertices of each
  std::vector<std::vector<Index>> chunks_of_range_;
};
} // namespace fresco::poisson
