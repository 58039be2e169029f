// SPDX-License-Identifier: BSD-3-Clause
#include "views/hidden_parts.h"
#include "views/patch_visibility.h"
#include <algorithm>
#include <fresco/core/parallel.h>
namespace fresco::texture {
namespace {
constexpr int rounds = 3;                  // each halves the sides
constexpr Index cells_of_all = 64'000'000; // 128 MB

std::vector<DepthMap> coarseMaps(const RayScene& scene, const ViewList& views, int threads)
{
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

/// Whether some view shows a part of the patch, but none the whole.
bool isOnlySeenInPart(const PatchMesh& patches, Index patch, const ViewList& views, const std::vector<DepthMap>& maps,
                      float tolerance)
{
  bool in_part = false;
  for (std::size_t v = 0; v < maps.size(); ++v) {
    if (maps[v].depth.empty() || !(cosineTowards(patches, patch, views.projectors[v]) >= least_cosine))
      continue;
    Eigen::Matrix3f pixels;
    for (int k = 0; k < 3; ++k)
      pixels.col(k) = pixelWithin(views.projectors[v], patches.vertices.col(patches.faces(k, patch)));
    if (!(pixels.row(2).minCoeff() > 0))
      continue;
    const Footprint footprint = footprintOf(pixels, maps[v].step);
    if (sightOf(footprint, maps[v], tolerance) != Sight::hidden)
      return false;
    in_part = in_part || isSeenInPart(footprint, maps[v], tolerance);
  }
  return in_part;
}
} // namespace

PatchMesh cutHiddenParts(PatchMesh patches, const RayScene& scene, const ViewList& views, const TextureOptions& options)
{
  const std::vector<DepthMap> maps = coarseMaps(scene, views, options.threads);
  const float tolerance = limitsFor(patches, views, options).tolerance;
  for (int round = 0; round < rounds; ++round) {
    std::vector<char> marked(patches.size());
    parallelFor(patches.size(), options.threads,
                [&](Index i) { marked[i] = isOnlySeenInPart(patches, i, views, maps, tolerance); });
    patches = cutPatches(patches, marked, options.threads);
  }
  return patches;
}
} // namespace fresco::texture
