// SPDX-License-Identifier: BSD-3-Clause
#include "views/visible_surface.h"
#include "views/patch_visibility.h"
#include "views/view_selection.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/parallel.h>
#include <fresco/core/statistics.h>
#include <map>
namespace fresco::texture {
namespace {
/// Longest side of a patch, mesh units.
float longestEdge(const TriangleMesh& mesh, const std::vector<Projector>& views, Index tiles)
{
  constexpr float patch_pixels = 16; // small against what stands before a surface, many pixels to compare colours by
  const Index stride = std::max<Index>(1, mesh.faceCount() / median_samples);
  std::vector<float> sizes; // of a pixel
  for (const Projector& view : views)
    for (Index f = 0; f < mesh.faceCount(); f += stride) {
      const Eigen::Vector3f p = view(mesh.vertices.col(mesh.faces(0, f)));
      if (p.z() > 0 && p.x() >= 0 && p.y() >= 0 && p.x() <= view.camera().width && p.y() <= view.camera().height)
        sizes.push_back(p.z() / view.focal());
    }
  const float least = std::sqrt(surfaceArea(mesh) / (0.43 * most_patches * tiles));
  if (sizes.empty())
    return std::max<double>(least, 0.05 * diagonalOf(mesh));
  return std::max(least, patch_pixels * median(sizes));
}

/// For each face the view that most of its area is taken from.
Eigen::VectorXi viewsOfFaces(const PatchMesh& patches, const Eigen::VectorXi& view, Index faces)
{
  Eigen::VectorXi out = Eigen::VectorXi::Constant(faces, -1);
  std::map<int, float> areas; // of the views of one face
  for (Index i = 0; i < view.size(); ++i) {
    if (i == 0 || patches.parent[i] != patches.parent[i - 1])
      areas.clear();
    areas[view[i]] += patches.areas[i];
    out[patches.parent[i]] = std::max_element(areas.begin(), areas.end(), [](const auto& a, const auto& b) {
                               return a.second < b.second;
                             })->first;
  }
  return out;
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

Eigen::AlignedBox3f boxOf(const TriangleMesh& mesh)
{
  Eigen::AlignedBox3f box;
  for (Index i = 0; i < mesh.faces.size(); ++i)
    box.extend(mesh.vertices.col(mesh.faces.data()[i]));
  return box;
}

double diagonalOf(const TriangleMesh& mesh) { return boxOf(mesh).sizes().norm(); }

WholeSurface measureSurface(const TriangleMesh& mesh, const ViewList& views, Index tiles)
{
  return {{}, {}, longestEdge(mesh, views.projectors, tiles), typicalDepth(mesh.vertices, views.projectors)};
}

std::vector<DepthMap> coarseMaps(const VisibilityInput& input)
{
  constexpr Index cells_of_all = 64'000'000; // 256 MB
  const ViewList& views = input.views;
  const Index n = views.projectors.size();
  std::vector<DepthMap> maps(views.projectors.size());
  const auto make = [&](Index v) {
    if (views.used[v])
      maps[v] = shownDepth(input, v, std::min(most_cells, cells_of_all / n));
  };
  parallelFor(n, input.options.threads, make, 1);
  return maps;
}

PatchMesh cutHiddenParts(PatchMesh patches, const VisibilityInput& input, const std::vector<DepthMap>& maps)
{
  const int threads = input.options.threads;
  const DepthTest test{input.views.projectors, maps, limitsFor(patches, input).tolerance};
  constexpr int rounds = 3; // each halves the sides: patches of 2 pixels
  Index known = 0;          // vertices: patches that were cut have later ones, others stay as they were judged
  for (int round = 0; round < rounds; ++round) {
    std::vector<char> marked(patches.size());
    parallelFor(patches.size(), threads, [&](Index i) {
      marked[i] = patches.faces.col(i).maxCoeff() >= known && isOnlySeenInPart(patches, i, test);
    });
    known = patches.vertices.cols();
    patches = cutPatches(patches, marked, threads);
  }
  return patches;
}

VisibleSurface findVisibleSurface(const TriangleMesh& mesh, const VisibilityInput& input, const Progress& progress)
{
  const bool exact = input.views.pose_uncertainty < 1; // else outlines are too uncertain to be followed closely
  VisibleSurface out;
  const WholeSurface* whole = input.whole;
  out.patches =
      cutFaces(mesh, whole ? whole->longest_edge : longestEdge(mesh, input.views.projectors, 1), input.options.threads);
  if (!exact) {
    out.candidates = findCandidates(out.patches, input, progress);
    return out;
  }
  std::vector<DepthMap> maps;
  if (!whole)
    maps = coarseMaps(input);
  out.patches = cutHiddenParts(std::move(out.patches), input, whole ? whole->maps : maps);
  out.candidates = findCandidates(out.patches, input, progress, std::move(maps), whole ? nullptr : &out.outlines);
  return out;
}

void describeViews(const PatchMesh& patches, const Eigen::VectorXi& view, TextureResult& result)
{
  double seen = 0;
  std::vector<char> used(view.maxCoeff() + 1, 0);
  for (Index i = 0; i < view.size(); ++i)
    if (view[i] >= 0) {
      seen += patches.areas[i];
      used[view[i]] = 1;
    }
  result.coverage = std::min(1.0, seen / patches.areas.head(view.size()).cast<double>().sum());
  result.views_used = std::count(used.begin(), used.end(), 1);
  result.seam_length = seamLength(patches, view);
  result.face_view = viewsOfFaces(patches, view, result.model.mesh.faceCount());
}
} // namespace fresco::texture
