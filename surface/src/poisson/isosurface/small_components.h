// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/isosurface/isosurface.h"
#include <fresco/core/exchange.h>
#include <fresco/core/union_find.h>
namespace fresco::poisson {
/// Connected components of a surface. Those are small that are too small to be more than a ripple of chi around single
/// samples: of fewer faces than a ball four cells across, and far smaller than the largest component.
class Components {
public:
  Components(const IsoSurface& surface, int threads);

  /// Lowest vertex of the component; and the number of its faces, which may be set where it goes on at other ranks.
  std::uint32_t rootOf(Index v) const { return static_cast<std::uint32_t>(sets_.root(v)); }
  std::uint32_t faces(Index root) const { return faces_[root].load(std::memory_order_relaxed); }
  void setFaces(Index root, std::uint32_t count) { faces_[root].store(count, std::memory_order_relaxed); }

  /// Compares all components, also those of other ranks. @return whether there are small ones
  bool findSmall(Exchange& exchange);
  bool isSmall(Index v) const { return isSmallCount(faces(rootOf(v))); }

private:
  bool isSmallCount(std::uint32_t faces) const;

  mutable ConcurrentUnionFind sets_;        ///< finding a root makes paths shorter
  Array<std::atomic<std::uint32_t>> faces_; ///< by root
  double largest_ = 0;
  int threads_;
};

/// Removes the small components. Ranges and vertex order are kept.
void removeSmallComponents(IsoSurface& surface, int threads);
} // namespace fresco::poisson
