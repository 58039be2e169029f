// SPDX-License-Identifier: BSD-3-Clause
#include "tiles/tile_atlases.h"
#include "charts/chart.h"
#include "photographs/input_checks.h"
#include <fresco/core/require.h>
namespace fresco::texture {
TileAtlases::TileAtlases(const AtlasSink& take, TextureResult& result) : take_(take), result_(result)
{
  const Index faces = result.model.mesh.faceCount();
  result.model.texcoord_faces = Faces::Constant(3, faces, -1);
  result.model.face_atlas = Eigen::VectorXi::Constant(faces, -1);
  result.face_view = Eigen::VectorXi::Constant(faces, -1);
}

void TileAtlases::add(const MeshTiles& tiles, Index tile, TextureResult painted)
{
  takeFaces(tiles, tile, painted);
  double area = 0;
  for (Index i = tiles.begin[tile]; i < tiles.begin[tile + 1]; ++i)
    area += 0.5 * areaVector(result_.model.mesh, tiles.order[i]).norm();
  area_ += area;
  seen_ += area * painted.coverage;
  sizes_.emplace_back(painted.texel, area);
  result_.charts += painted.charts;
  result_.seam_length += painted.seam_length;
  for (const std::string& warning : painted.warnings)
    result_.warnings.push_back(concat("tile ", tile + 1, ": ", warning));
  takeAtlases(painted);
}

void TileAtlases::takeFaces(const MeshTiles& tiles, Index tile, const TextureResult& painted)
{
  const int texcoord = texcoords_.size() / 2, atlas = result_.model.atlases.size();
  for (Index i = tiles.begin[tile]; i < tiles.begin[tile + 1]; ++i) {
    const Index from = i - tiles.begin[tile], to = tiles.order[i];
    result_.face_view[to] = painted.face_view[from];
    if (painted.model.face_atlas[from] < 0)
      continue;
    result_.model.face_atlas[to] = painted.model.face_atlas[from] + atlas;
    result_.model.texcoord_faces.col(to) = painted.model.texcoord_faces.col(from).array() + texcoord;
  }
  texcoords_.insert(texcoords_.end(), painted.model.texcoords.data(),
                    painted.model.texcoords.data() + painted.model.texcoords.size());
}

void TileAtlases::takeAtlases(TextureResult& painted)
{
  for (std::size_t i = 0; i < painted.model.atlases.size(); ++i) {
    Image &atlas = painted.model.atlases[i], &mask = painted.masks[i];
    const double texels = 1.0 * atlas.width * atlas.height;
    texels_ += texels;
    owned_ += texels * painted.used;
    if (take_) {
      take_(atlas, mask);
      for (Image* image : {&atlas, &mask})
        std::vector<std::uint8_t>().swap(image->data);
    }
    result_.model.atlases.push_back(std::move(atlas));
    result_.masks.push_back(std::move(mask));
  }
}

void TileAtlases::finish()
{
  result_.model.texcoords = Eigen::Map<const Eigen::Matrix2Xf>(texcoords_.data(), 2, texcoords_.size() / 2);
  result_.coverage = area_ > 0 ? seen_ / area_ : 0;
  result_.used = texels_ > 0 ? owned_ / texels_ : 0;
  result_.texel = sizes_.empty() ? 0 : weightedQuantile(sizes_, 0.5);
}

bool removeDuplicates(const MeshTiles& tiles, TriangleMesh& mesh, std::vector<std::string>& warnings)
{
  std::vector<char> kept(mesh.faceCount(), 0);
  Index count = 0;
  for (Index t = 0; t < tiles.count(); ++t)
    for (const Index i : firstFaces(tileMesh(mesh, tiles, t, -1).mesh.faces)) {
      kept[tiles.order[tiles.begin[t] + i]] = 1;
      ++count;
    }
  const Index all = mesh.faceCount();
  if (count == all)
    return false;
  for (Index f = 0, to = 0; f < all; ++f)
    if (kept[f])
      mesh.faces.col(to++) = mesh.faces.col(f).eval();
  mesh.faces.conservativeResize(3, count);
  warnings.push_back(duplicatesWarning(all - count));
  return true;
}
} // namespace fresco::texture
