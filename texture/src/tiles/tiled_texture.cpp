// SPDX-License-Identifier: BSD-3-Clause
#include "tiles/tiled_texture.h"
#include "cameras/camera_refinement.h"
#include "photographs/input_checks.h"
#include "tiles/coarse_mesh.h"
#include "tiles/photo_painting.h"
#include "tiles/tile_traces.h"
#include "views/face_orientation.h"
#include "views/patch_visibility.h"
#include <algorithm>
#include <fresco/core/parallel.h>
#include <fresco/core/require.h>
#include <fresco/core/statistics.h>
namespace fresco::texture {
namespace {
Eigen::AlignedBox3f widened(const Eigen::AlignedBox3f& box, float by)
{
  return {box.min().array() - by, box.max().array() + by};
}

class TiledTexture {
public:
  TiledTexture(TriangleMesh mesh, const std::vector<TextureView>& views, const TextureOptions& options,
               const Progress& progress)
      : options_(options), progress_(progress), given_(views), parts_(partsOf(views)),
        photos_(parts_, std::size_t(options.memory) << 20), steps_(progress, result_)
  {
    result_.model.mesh = std::move(mesh);
  }

  TextureResult run(const Tiling& tiling)
  {
    steps_.begin("photographs", 0.0);
    checkPhotos(photos_, parts_, options_, result_);
    tiles_ = cutIntoTiles(result_.model.mesh, tiling.faces);
    if (removeDuplicates(tiles_, result_.model.mesh, result_.warnings))
      tiles_ = cutIntoTiles(result_.model.mesh, tiling.faces);
    solveWhole(tiling.faces);
    const ViewList list = viewList(projectors_, photos_, parts_, result_);
    list_ = &list;
    makeMaps();
    halo_ = halo_patches * meanEdge(result_.model.mesh, 0.75f * whole_.longest_edge); // halves are cut from longer ones
    chooseAll();
    paintAll(tiling.take);
    warnOfLittleSeen(result_.coverage, given_, result_);
    steps_.begin("done", 1.0);
    return std::move(result_);
  }

private:
  /// Cameras, exposures and measures, by a mesh that memory holds as easily as a tile.
  void solveWhole(Index tile_faces)
  {
    constexpr Index least_faces = 200'000; // cost little, and small meshes lose nothing
    steps_.begin("camera refinement", 0.05);
    const TriangleMesh mesh = coarseMesh(result_.model.mesh, std::max(tile_faces, least_faces));
    const RayScene rays(mesh);
    placeCameras({mesh, rays, parts_, photos_}, options_, subProgress(progress_, 0.05, 0.15), result_);
    projectors_ = projectorsOf(mesh, parts_, result_.cameras);
    warnOfMisfits(parts_, result_);
    TextureResult turned;
    if (sameUnits(mesh, given_) && !insideOutFaces(mesh, rays, projectors_, turned).empty())
      result_.warnings.emplace_back(
          "parts of the mesh are turned inside out, and stay so since it is textured in tiles: photographs see them "
          "from behind alone");
    const ViewList list = viewList(projectors_, photos_, parts_, result_);
    whole_ = measureSurface(result_.model.mesh, list, tiles_.count());
    steps_.begin("exposure", 0.15);
    VisibleSurface surface;
    if (options_.exposure)
      surface = findVisibleSurface(mesh, {&rays, list, options_}, subProgress(progress_, 0.15, 0.2));
    photometry_ = findPhotometry(surface.candidates, {options_, list, steps_, result_});
  }

  void makeMaps()
  {
    steps_.begin("depth maps", 0.2);
    whole_.maps.resize(projectors_.size());
    const auto start = [&](Index v) {
      if (list_->used[v])
        whole_.maps[v] = emptyMap(projectors_[v].camera(), most_cells);
    };
    parallelFor(projectors_.size(), options_.threads, start, 1);
    for (Index t = 0; t < tiles_.count(); ++t) {
      report(progress_, "depth maps", 0.2 + 0.05 * t / tiles_.count());
      const TileMesh tile = tileMesh(result_.model.mesh, tiles_, t, -1);
      const RayScene scene(tile.mesh);
      const auto add = [&](Index v) {
        if (list_->used[v])
          addPart({scene, tiles_.boxes[t]}, projectors_[v], whole_.maps[v]);
      };
      parallelFor(projectors_.size(), options_.threads, add, 1);
    }
    const float tolerance = limitsFor({}, input()).tolerance;
    whole_.outlines.resize(list_->pose_uncertainty < 1 ? projectors_.size() : 0);
    const auto finish = [&](Index v) {
      if (!list_->used[v])
        return;
      hideMasked(photos_.mask(v), whole_.maps[v]);
      if (!whole_.outlines.empty())
        whole_.outlines[v] = OutlineMask(whole_.maps[v], interpolation_reach, tolerance);
    };
    parallelFor(projectors_.size(), options_.threads, finish, 1);
  }

  VisibilityInput input() const { return {nullptr, *list_, options_, &whole_}; }

  /// What the photographs show of a tile and what lies around it.
  ViewChoice look(const TileMesh& tile)
  {
    ViewChoice out;
    steps_.begin("visibility", 0.25);
    out.surface = findVisibleSurface(tile.mesh, input(), {});
    out.photometry = photometry_;
    steps_.begin("view selection", 0.4);
    compareViews(input(), out);
    return out;
  }

  /// @param pass 0 or 1, of two
  void beginTile(Index tile, int pass)
  {
    const double part = 0.375 / tiles_.count(), from = 0.25 + 0.375 * pass + part * tile;
    steps_.setPart(concat("tile ", tile + 1, " of ", tiles_.count(), ": "), from, from + part);
  }

  void chooseAll()
  {
    const double seam_cost = options_.smoothness * diagonalOf(result_.model.mesh);
    std::vector<double> rounds;
    for (Index t = 0; t < tiles_.count(); ++t) {
      beginTile(t, 0);
      const TileMesh tile = tileMesh(result_.model.mesh, tiles_, t, halo_);
      ViewChoice choice = look(tile);
      chooseViews(options_, seam_cost, choice);
      rounds.push_back(blendRounds({options_, *list_, steps_, result_}, choice));
      traces_.add(tile, choice.surface.patches, choice.view);
    }
    blend_rounds_ = median(rounds);
  }

  /// As chosen by each patch's own tile.
  Eigen::VectorXi chosenViews(const TileMesh& tile, Index number, const VisibleSurface& surface) const
  {
    Eigen::VectorXi out = traces_.views(tile, number, surface.patches);
    for (Index i = 0; i < out.size(); ++i)
      if (out[i] >= 0 && !surface.candidates.find(i, out[i])) // at the rim, where patches are cut otherwise
        out[i] = -1;
    return out;
  }

  void paintAll(const AtlasSink& take)
  {
    TileAtlases atlases(take, result_);
    std::vector<char> used(given_.size(), 0);
    for (Index t = 0; t < tiles_.count(); ++t) {
      beginTile(t, 1);
      const TileMesh tile = tileMesh(result_.model.mesh, tiles_, t, halo_);
      ViewChoice choice = look(tile);
      choice.view = chosenViews(tile, t, choice.surface);
      TextureResult painted = paint(tile, t, choice);
      for (Index i = 0; i < Index(traces_.viewsOf(t).size()); ++i)
        if (choice.view[i] >= 0)
          used[list_->owner[choice.view[i]]] = 1;
      atlases.add(tiles_, t, std::move(painted));
    }
    atlases.finish();
    result_.views_used = std::count(used.begin(), used.end(), 1);
  }

  TextureResult paint(const TileMesh& tile, Index number, ViewChoice& choice)
  {
    TextureResult painted;
    painted.model.mesh = tile.mesh;
    painted.cameras = result_.cameras;
    painted.fits = result_.fits;
    painted.disagreement_before = result_.disagreement_before;
    painted.disagreement_after = result_.disagreement_after;
    const Index own = TileTraces::ownPatches(tile, choice.surface.patches);
    border_.setOwn(own);
    const float edge = halo_ / halo_patches;
    std::vector<Eigen::AlignedBox3f> open;
    for (Index t = number + 1; t < tiles_.count(); ++t)
      if (tiles_.boxes[t].intersects(widened(tiles_.boxes[number], 4 * edge)))
        open.push_back(widened(tiles_.boxes[t], 4 * edge));
    border_.setOpen(std::move(open));
    const Points known = traces_.colors(tile, choice.surface.patches);
    const Points colors = paintModel({options_, *list_, steps_, painted}, choice,
                                     {tile.own, own, blend_rounds_, &border_, &known, &whole_.outlines});
    traces_.setColors(number, colors);
    return painted;
  }

  const TextureOptions& options_;
  const Progress& progress_;
  const std::vector<TextureView>& given_;
  TextureResult result_;
  std::vector<ViewPart> parts_;
  PhotoStore photos_;
  Steps steps_;
  MeshTiles tiles_;
  std::vector<Projector> projectors_;
  const ViewList* list_ = nullptr;
  WholeSurface whole_;
  Photometry photometry_;
  float halo_ = 0; ///< mesh units
  int blend_rounds_ = 0;
  TileTraces traces_;
  BorderOffsets border_;
};
} // namespace

TextureResult textureInTiles(TriangleMesh mesh, const std::vector<TextureView>& views, const TextureOptions& options,
                             const Progress& progress, const Tiling& tiling)
{
  return TiledTexture(std::move(mesh), views, options, progress).run(tiling);
}
} // namespace fresco::texture
