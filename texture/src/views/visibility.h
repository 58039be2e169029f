// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "photographs/photo_store.h"
#include "photographs/photometry.h"
#include "photographs/projector.h"
#include "views/outline_mask.h"
#include "views/patch_mesh.h"
#include <array>
#include <cmath>
#include <fresco/core/progress.h>
#include <fresco/texture/core/texture_reconstruction.h>
namespace fresco::texture {
/// A view that shows a patch.
struct Candidate {
  std::int32_t view : 23;
  std::uint32_t clipped : 1;         ///< a part of the patch is overexposed
  std::uint32_t radius : 8;          ///< of the patch's middle in the photograph, see storedRadius()
  std::array<std::uint8_t, 3> color; ///< mean over the patch in the photograph
  std::uint8_t contrast;             ///< half grey levels, deviation within the patch
  /// Pixels per mesh unit in the direction seen most obliquely, less where the view is to be trusted less: outlines, the
  /// image's border.
  float quality;

  float squaredRadius() const { return static_cast<float>(radius) / radius_steps; }
  Eigen::Vector3f corrected(const Photometry& photometry) const
  {
    return photometry.corrected(view, squaredRadius(), Eigen::Vector3f(color[0], color[1], color[2]));
  }
};

/// For each patch the views that show the whole of it, by view number.
struct Candidates {
  std::vector<Index> begin; ///< P + 1, into `list`
  std::vector<Candidate> list;

  Index count(Index patch) const { return begin[patch + 1] - begin[patch]; }
  const Candidate* of(Index patch) const { return list.data() + begin[patch]; }
  float bestQuality(Index patch) const; ///< 0 without candidates
  /// The candidate of that view, or null.
  const Candidate* find(Index patch, int view) const;
};

/// What one view shows.
struct SeenPatch {
  int patch;
  Candidate candidate;
};

/// Collects candidates view by view and keeps the best ones of each patch.
class CandidateTable {
public:
  /// @param most candidates kept per patch, > 0
  CandidateTable(Index patches, Index most);
  /// How many are to be kept: all, unless patches and views are so many that this would need much memory.
  static Index mostPerPatch(Index patches, Index views);
  /// @param views by patch what each shows, later ones than any before; of equal candidates the earlier view's stays
  void add(const std::vector<std::vector<SeenPatch>>& views, int threads);
  /// Everything that was kept; the table is of no use afterwards.
  Candidates take() { return std::move(kept_); }

private:
  void keep(const Candidate& candidate, Candidate* first, Index& count) const;

  Index most_;
  Candidates kept_;
};

struct ViewList {
  const std::vector<Projector>& projectors;
  PhotoStore& photos;
  std::vector<char> used; ///< views that may become candidates
  std::vector<int> owner; ///< number of what each is a part of: parts of one panorama share it
  double pose_uncertainty =
      1; ///< how far outlines are to be distrusted: 1 = by some pixels and centimetres, 0 = all is exact
  std::vector<int> lenses;     ///< of each view, see lensNumbers()
  std::vector<double> misfits; ///< octaves by which each view is trusted less; empty: none
};

/// What is to be known of a surface as a whole when a part of it is looked at.
struct WholeSurface {
  std::vector<DepthMap> maps;        ///< shownDepth() of each view in use, as fine as can be
  std::vector<OutlineMask> outlines; ///< of each view in use, or none where poses are too uncertain
  float longest_edge = 0;            ///< of a patch, mesh units
  float typical_depth = 0;           ///< from the cameras, mesh units
};

/// What visibility is judged by.
struct VisibilityInput {
  const RayScene* scene; ///< of the whole mesh; null if there is `whole`
  const ViewList& views;
  const TextureOptions& options;
  const WholeSurface* whole = nullptr; ///< in place of the scene where the patches are a part of the surface
};

/// Brings what a mask leaves out of the surface to before the lens. Beside the surface it only says what the map does.
void hideMasked(Image mask, DepthMap& map);

/// Depth of what a view shows in at most `cells` cells. Where its mask says not to use the photograph, something stands before the lens.
DepthMap shownDepth(const VisibilityInput& input, Index view, Index cells);

/// A patch counts as seen by a view where all of it lies in the image, turned towards the camera, and no ray through
/// the pixels that it covers ends clearly before it.
/// @param maps     shownDepth() of each view in any number of cells, or none; those as fine as can be are used up
/// @param outlines of each view in use, if not null; they need the same depth
Candidates findCandidates(const PatchMesh& patches, const VisibilityInput& input, const Progress& progress,
                          std::vector<DepthMap> maps = {}, std::vector<OutlineMask>* outlines = nullptr);
} // namespace fresco::texture
