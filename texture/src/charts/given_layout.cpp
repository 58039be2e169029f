// SPDX-License-Identifier: BSD-3-Clause
#include "charts/given_layout.h"
#include "charts/chart_raster.h"
#include "photographs/photo_store.h"
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <fresco/core/require.h>
#include <fresco/core/union_find.h>
#include <numeric>
namespace fresco::texture {
namespace {
Eigen::Vector2f coordinate(const TexturedMesh& model, int k, Index face)
{
  return model.texcoords.col(model.texcoord_faces(k, face));
}

/// Gives an atlas its size; the images' own contents are not used.
/// @param wanted side in texels of an atlas that has no size
Image emptyAtlas(const Image& given, double wanted, int longest)
{
  constexpr int largest = 16384; // texels; images smaller than the least stand for a colour
  const bool sized = std::min(given.width, given.height) >= least_atlas;
  double width = sized ? given.width : wanted, height = sized ? given.height : wanted;
  if (longest > 0) {
    const double scale = longest / std::max(width, height);
    width *= scale;
    height *= scale;
  }
  return Image(std::clamp<int>(std::lround(width), least_atlas, largest),
               std::clamp<int>(std::lround(height), least_atlas, largest), 3, mid_grey);
}

/// Side of a square atlas in which the faces have about as many texels as wanted.
double wantedSide(const FaceGraph& graph, const Eigen::VectorXf& density, const TexturedMesh& model)
{
  double texels = 0, share = 0;
  for (Index f = 0; f < model.mesh.faceCount(); ++f) {
    if (model.face_atlas[f] < 0)
      continue;
    const Eigen::Vector2f a = coordinate(model, 0, f), u = coordinate(model, 1, f) - a, v = coordinate(model, 2, f) - a;
    texels += graph.areas[f] * density[f] * density[f];
    share += 0.5 * std::abs(u.x() * v.y() - u.y() * v.x());
  }
  return std::clamp<double>(share > 0 ? std::sqrt(texels / share) : 0, least_atlas, largest_atlas);
}

/// Texel of the face's atlas = map * (vertex, 1), exact on the face's plane.
Eigen::Matrix<double, 2, 4> faceMap(const TexturedMesh& model, Index face)
{
  const Image& atlas = model.atlases[model.face_atlas[face]];
  Eigen::Matrix<double, 2, 3> texels;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector2f at = coordinate(model, k, face);
    texels.col(k) << at.x() * atlas.width, (1.0 - at.y()) * atlas.height;
  }
  const Eigen::Vector3d a = faceCorner(model.mesh, face, 0);
  Eigen::Matrix<double, 3, 2> sides;
  sides << faceCorner(model.mesh, face, 1) - a, faceCorner(model.mesh, face, 2) - a;
  Eigen::Matrix<double, 2, 4> map;
  map.leftCols<3>() =
      (texels.rightCols<2>().colwise() - texels.col(0)) * sides.completeOrthogonalDecomposition().pseudoInverse();
  map.col(3) = texels.col(0) - map.leftCols<3>() * a;
  return map;
}

/// Number of the island of each face: neighbours whose coordinates agree along their edge are of one.
std::vector<int> islandsOf(const FaceGraph& graph, const TexturedMesh& model)
{
  const auto cornerAt = [&](Index face, int vertex) {
    int k = 0;
    while (k < 2 && model.mesh.faces(k, face) != vertex)
      ++k;
    return coordinate(model, k, face);
  };
  const Index faces = model.mesh.faceCount();
  UnionFind joined(faces);
  for (Index f = 0; f < faces; ++f)
    for (int k = 0; k < 3 && model.face_atlas[f] >= 0; ++k)
      if (const int other = graph.neighbors(k, f);
          other > f && model.face_atlas[other] == model.face_atlas[f] &&
          cornerAt(other, model.mesh.faces(k, f)) == coordinate(model, k, f) &&
          cornerAt(other, model.mesh.faces((k + 1) % 3, f)) == coordinate(model, (k + 1) % 3, f))
        joined.join(f, other);
  std::vector<int> number(faces, -1), out(faces);
  int islands = 0;
  for (Index f = 0; f < faces; ++f) {
    int& island = number[joined.root(f)];
    out[f] = island = island < 0 ? islands++ : island;
  }
  return out;
}

/// Moves the texels of an atlas' faces to their islands.
void share(const Chart& whole, const PatchMesh& patches, const std::vector<int>& islands, std::vector<Chart>& charts)
{
  const OwnedTexels& all = whole.texels;
  for (std::size_t s = 0; s < all.patches.size(); ++s) {
    OwnedTexels& texels = charts[islands[patches.parent[all.patches[s]]]].texels;
    texels.patches.push_back(all.patches[s]);
    texels.begin.push_back(texels.spans.size());
    texels.spans.insert(texels.spans.end(), all.spans.begin() + all.begin[s], all.spans.begin() + all.begin[s + 1]);
  }
}

/// Lets the chart be no larger than its texels.
void fitChart(Chart& chart)
{
  chart.texels.begin.push_back(chart.texels.spans.size());
  Eigen::AlignedBox2i box;
  for (const TexelSpan& span : chart.texels.spans) {
    box.extend(Eigen::Vector2i(span.x, span.y));
    box.extend(Eigen::Vector2i(span.x + span.length, span.y + 1));
  }
  chart.x = box.min().x();
  chart.y = box.min().y();
  chart.width = box.sizes().x();
  chart.height = box.sizes().y();
  for (TexelSpan& span : chart.texels.spans) {
    span.x -= chart.x;
    span.y -= chart.y;
  }
}
} // namespace

void validateLayout(const TexturedMesh& model)
{
  const Index faces = model.mesh.faceCount(), atlases = model.atlases.size();
  require(model.texcoord_faces.cols() == faces && model.face_atlas.size() == faces, "texture: ", faces, " faces, ",
          model.texcoord_faces.cols(), " with texture coordinates, ", model.face_atlas.size(), " with an atlas");
  for (Index f = 0; f < faces; ++f) {
    const int atlas = model.face_atlas[f];
    const bool flat = atlas < 0 && areaVector(model.mesh, f).isZero(0);
    require((atlas >= 0 && atlas < atlases) || flat, "texture: face ", f,
            " has no texture coordinates that could be kept");
    for (int k = 0; k < 3 && !flat; ++k) {
      const int t = model.texcoord_faces(k, f);
      require(t >= 0 && t < model.texcoords.cols(), "texture: face ", f, " names texture coordinate ", t,
              ", there are ", model.texcoords.cols());
      const Eigen::Vector2f at = model.texcoords.col(t);
      require((at.array() >= 0).all() && (at.array() <= 1).all(), "texture: face ", f, " has the texture coordinates ",
              at.x(), ' ', at.y(), ", which are not in 0..1");
    }
  }
}

std::vector<Chart> keepLayout(const PatchMesh& patches, const FaceGraph& graph, const Eigen::VectorXf& density,
                              const TextureOptions& options, TexturedMesh& model)
{
  const double side = wantedSide(graph, density, model);
  for (Image& atlas : model.atlases)
    atlas = emptyAtlas(atlas, side, options.atlas);
  const Index faces = model.mesh.faceCount();
  auto maps = std::make_shared<std::vector<Eigen::Matrix<double, 2, 4>>>(faces);
  std::vector<Chart> wholes(model.atlases.size());
  for (Index f = 0; f < faces; ++f)
    if (model.face_atlas[f] >= 0) {
      (*maps)[f] = faceMap(model, f);
      wholes[model.face_atlas[f]].faces.push_back(f);
    }
  const std::vector<int> islands = islandsOf(graph, model);
  std::vector<Chart> charts(faces > 0 ? 1 + *std::max_element(islands.begin(), islands.end()) : 0);
  for (Index f = 0; f < faces; ++f) {
    Chart& chart = charts[islands[f]];
    chart.faces.push_back(f);
    chart.atlas = model.face_atlas[f];
    chart.given = maps;
  }
  const std::vector<Index> first = patchesOfFaces(patches, faces);
  for (std::size_t a = 0; a < wholes.size(); ++a) {
    Chart& whole = wholes[a];
    whole.given = maps;
    whole.width = model.atlases[a].width;
    whole.height = model.atlases[a].height;
    const std::vector<int> out = rasterizeChart(patches, first, options.border, whole);
    require(out.empty(), "texture: the texture coordinates overlap: face ", out.empty() ? -1 : out[0],
            " lies on another, and so do ", std::max<std::size_t>(out.size(), 1) - 1, " more");
    share(whole, patches, islands, charts);
    whole.texels = {};
  }
  charts.erase(std::remove_if(charts.begin(), charts.end(), [](const Chart& c) { return c.texels.patches.empty(); }),
               charts.end());
  for (Chart& chart : charts)
    fitChart(chart);
  return charts;
}
} // namespace fresco::texture
