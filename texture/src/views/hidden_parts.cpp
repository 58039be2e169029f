// SPDX-License-Identifier: BSD-3-Clause
#include "views/hidden_parts.h"
#include "views/patch_visibility.h"
#include <algorithm>
#include <fresco/core/parallel.h>
namespace fresco::texture {
namespace {
std::vector<DepthMap> coarseMaps(const RayScene& scene, const ViewList& views, int threads)
{
  constexpr Index cells_of_all = 64'000'000; // 256 MB
  const Index n = views.projectors.size();
  std::vector<DepthMap> maps(views.projectors.size());
  parallelFor(
      n, threads,
      [&](Index v) {
        if (views.used[v])
          maps[v] = depthMap(scene, views.projectors[v], std::min(most_cells, cells_of_all / n));
      },
      1);
  return maps;
}

struct DepthTest {
  const std::vector<Projector>& projectors;
  const std::vector<DepthMap>& maps; ///< of each; empty where not in use
  float tolerance;                   ///< mesh units
};

/// Whether some view shows a part of the patch, but none the whole.
bool isOnlySeenInPart(const PatchMesh& patches, Index patch, const DepthTest& test)
{
  const auto& [projectors, maps, tolerance] = test;
  bool in_part = false;
  for (std::size_t v = 0; v < maps.size(); ++v) {
    if (maps[v].depth.empty() || !(cosineTowards(patches, patch, projectors[v]) >= least_cosine))
      continue;
    Eigen::Matrix3f pixels;
    for (int k = 0; k < 3; ++k)
      pixels.col(k) = pixelWithin(projectors[v], patches.vertices.col(patches.faces(k, patch)));
    if (!(pixels.row(2).minCoeff() > 0))
      continue;
    const Footprint footprint = footprintOf(pixels, maps[v].step);
    if (visibilityOf(footprint, maps[v], tolerance) != Visibility::hidden)
      return false;
    in_part = in_part || isSeenInPart(footprint, maps[v], tolerance);
  }
  return in_part;
}
} // namespace

PatchMesh cutHiddenParts(PatchMesh patches, const VisibilityInput& input)
{
  const int threads = input.options.threads;
  const std::vector<DepthMap> maps = coarseMaps(input.scene, input.views, threads);
  const DepthTest test{input.views.projectors, maps, limitsFor(patches, input.views, input.options).tolerance};
  constexpr int rounds = 3; // each halves the sides: patches of 2 pixels
  for (int round = 0; round < rounds; ++round) {
    std::vector<char> marked(patches.size());
    parallelFor(patches.size(), threads, [&](Index i) { marked[i] = isOnlySeenInPart(patches, i, test); });
    patches = cutPatches(patches, marked, threads);
  }
  return patches;
}
} // namespace fresco::texture
