// SPDX-License-Identifier: BSD-3-Clause
#include "texture/texture_scene.h"
#include "tiles/coarse_mesh.h"
#include "tiles/mesh_tiles.h"
#include "tiles/tiled_texture.h"
#include "views/patch_mesh.h"
#include <fresco/texture/core/point_texture.h>
#include <gtest/gtest.h>
#include <iostream>
#include <map>
using namespace fresco::texture;
namespace fresco::test {
namespace {
/// A room with a chest in it. Photographs get brighter to one side, which no exposure explains: there are steps to be
/// levelled wherever two of them meet.
struct Room {
  TriangleMesh mesh;
  std::vector<TextureView> views;
  static constexpr int tile_faces = 1500;

  Room()
  {
    TriangleMesh walls;
    appendBox({-2, -1.5f, -1}, {2, 1.5f, 1}, true, walls);
    appendBox({-1.2f, -0.5f, -0.99f}, {-0.4f, 0.4f, -0.3f}, false, walls);
    const PatchMesh cut = cutFaces(walls, 0.16f, 1);
    mesh.vertices = cut.vertices;
    mesh.faces = cut.faces;
    for (const double x : {-1.6, 0.1, 1.6})
      for (const double y : {-1.1, 1.1})
        for (const int side : {-1, 1}) {
          views.push_back(
              photograph(walls, detailed, camera(160, 120, 90), lookAt({x, y, 0.3}, {side * 0.7, -y, -0.3})));
          Image& image = views.back().image;
          for (int at = 0; at < 160 * 120; ++at)
            for (int c = 0; c < 3; ++c)
              image.data[3 * at + c] *= 0.75 + 0.25 * (at % 160) / 160;
        }
  }

  TextureResult textured(int most_faces, int threads = 0) const
  {
    TextureOptions options;
    options.tile_faces = most_faces;
    options.threads = threads;
    options.refine = false;
    return reconstructTexture(mesh, views, options);
  }
};

/// Mean difference of the colours on both sides of edges.
struct Steps {
  double inside = 0, border = 0; ///< grey levels; at seams between charts of a tile, and between tiles
  int inside_edges = 0, border_edges = 0;
};

Steps stepsOf(const TexturedMesh& model, const MeshTiles& tiles)
{
  std::vector<int> tile_of(model.mesh.faceCount());
  for (Index t = 0; t < tiles.count(); ++t)
    for (Index i = tiles.begin[t]; i < tiles.begin[t + 1]; ++i)
      tile_of[tiles.order[i]] = static_cast<int>(t);
  const Eigen::Matrix3Xi neighbors = faceNeighbors(model.mesh.faces, 1);
  Steps out;
  for (Index f = 0; f < model.mesh.faceCount(); ++f)
    for (int k = 0; k < 3; ++k) {
      const int other = neighbors(k, f);
      if (other <= f)
        continue;
      const auto texcoordsAt = [&](Index face, int vertex) {
        for (int c = 0; c < 3; ++c)
          if (model.mesh.faces(c, face) == vertex)
            return model.texcoord_faces(c, face);
        return -1;
      };
      const int a = model.mesh.faces(k, f), b = model.mesh.faces((k + 1) % 3, f);
      if (texcoordsAt(f, a) == texcoordsAt(other, a))
        continue; // no seam
      const auto middle = [&](Index face) {
        Eigen::Vector3d weights = Eigen::Vector3d::Zero();
        for (int c = 0; c < 3; ++c)
          weights[c] = model.mesh.faces(c, face) == a || model.mesh.faces(c, face) == b ? 0.5 : 0;
        return colorAt(model, face, weights);
      };
      const double step = (middle(f) - middle(other)).cwiseAbs().mean();
      const bool border = tile_of[f] != tile_of[other];
      (border ? out.border : out.inside) += step;
      ++(border ? out.border_edges : out.inside_edges);
    }
  out.border /= std::max(1, out.border_edges);
  out.inside /= std::max(1, out.inside_edges);
  return out;
}
} // namespace

TEST(TextureTiles, HoldEachFaceOnceAndNoMoreThanAsked)
{
  const Room room;
  const MeshTiles tiles = cutIntoTiles(room.mesh, 700);
  std::vector<int> count(room.mesh.faceCount(), 0);
  for (const int f : tiles.order)
    ++count[f];
  EXPECT_EQ(count, std::vector<int>(count.size(), 1));
  for (Index t = 0; t < tiles.count(); ++t) {
    EXPECT_LE(tiles.begin[t + 1] - tiles.begin[t], 700);
    const TileMesh tile = tileMesh(room.mesh, tiles, t, 0.3f);
    EXPECT_GT(tile.mesh.faceCount(), tile.own);
    EXPECT_EQ(tile.mesh.faceCount() - tile.own, static_cast<Index>(tile.around.size()));
  }
  TriangleMesh pile; // of faces at one place
  pile.vertices = Points::Random(3, 3);
  pile.faces = Eigen::Vector3i(0, 1, 2).replicate(1, 9);
  EXPECT_EQ(cutIntoTiles(pile, 2).count(), 1);
}

TEST(TextureTiles, CoarseMeshKeepsPlanesAndEdges)
{
  const Room room;
  const TriangleMesh coarse = coarseMesh(room.mesh, 1500);
  EXPECT_LE(coarse.faceCount(), 1500);
  EXPECT_GT(coarse.faceCount(), 300);
  EXPECT_NEAR(surfaceArea(coarse), surfaceArea(room.mesh), 0.03 * surfaceArea(room.mesh));
  const Eigen::AlignedBox3f walls(Eigen::Vector3f(-2, -1.5f, -1), Eigen::Vector3f(2, 1.5f, 1)),
      chest(Eigen::Vector3f(-1.2f, -0.5f, -0.99f), Eigen::Vector3f(-0.4f, 0.4f, -0.3f));
  for (Index v = 0; v < coarse.vertexCount(); ++v) {
    const Eigen::Vector3f p = coarse.vertices.col(v);
    const float to_wall = std::min((p - walls.min()).cwiseAbs().minCoeff(), (p - walls.max()).cwiseAbs().minCoeff());
    const float to_chest = std::min((p - chest.min()).cwiseAbs().minCoeff(), (p - chest.max()).cwiseAbs().minCoeff());
    EXPECT_LT(std::min(to_wall, to_chest), 0.02f) << p.transpose();
  }
  EXPECT_EQ(coarseMesh(room.mesh, room.mesh.faceCount()).faces, room.mesh.faces);
}

TEST(TextureTiles, OneTileIsTheWhole)
{
  const Room room;
  const TextureResult whole = room.textured(0), asked = room.textured(static_cast<int>(room.mesh.faceCount()));
  EXPECT_TRUE(sameAtlases(whole, asked));
  EXPECT_EQ(whole.model.texcoord_faces, asked.model.texcoord_faces);
  TextureOptions options;
  options.refine = false;
  const TextureResult tile = textureInTiles(room.mesh, room.views, options, {}, {room.mesh.faceCount(), {}});
  const auto same = (whole.face_view.array() == tile.face_view.array()).count();
  EXPECT_GT(same, 0.99 * room.mesh.faceCount()); // the typical depth is measured at other places
  EXPECT_NEAR(whole.coverage, tile.coverage, 1e-3);
  EXPECT_EQ(whole.views_used, tile.views_used);
}

TEST(TextureTiles, BordersShowNoMoreThanSeamsInside)
{
  const Room room;
  const TextureResult tiles = room.textured(Room::tile_faces), whole = room.textured(0);
  const Steps steps = stepsOf(tiles.model, cutIntoTiles(room.mesh, Room::tile_faces));
  std::cout << "seams inside tiles " << steps.inside << " grey levels (" << steps.inside_edges
            << " edges), between tiles " << steps.border << " (" << steps.border_edges << " edges)\n";
  ASSERT_GT(steps.border_edges, 100);
  EXPECT_LT(steps.border, steps.inside);
  EXPECT_LT(steps.border, 3); // below what the gradient of the photographs leaves without levelling
  const double error = colorError(tiles.model, detailed, 20).mean,
               whole_error = colorError(whole.model, detailed, 20).mean;
  std::cout << "mean error whole " << whole_error << ", tiles " << error << "\n";
  EXPECT_LT(error, 1.06 * whole_error);
}

TEST(TextureTiles, CoverEachFaceOnce)
{
  const Room room;
  const TextureResult result = room.textured(Room::tile_faces);
  EXPECT_GE(result.model.face_atlas.minCoeff(), 0);
  EXPECT_EQ(result.masks.size(), result.model.atlases.size());
  EXPECT_GE(result.model.atlases.size(), 4U);
  TextureOptions again;
  again.refine = false;
  again.rounds = 0;
  EXPECT_NO_THROW(
      reconstructTexture(result.model, room.views, again)); // a layout where two faces share a texel is refused
}

TEST(TextureTiles, ThreadsDoNotChangeThem)
{
  const Room room;
  const TextureResult one = room.textured(Room::tile_faces, 1), four = room.textured(Room::tile_faces, 4);
  EXPECT_TRUE(sameAtlases(one, four));
  EXPECT_EQ(one.face_view, four.face_view);
}

TEST(TextureTiles, AtlasesAreGivenAwayOneByOne)
{
  const Room room;
  TextureOptions options;
  options.tile_faces = Room::tile_faces;
  options.refine = false;
  std::vector<Image> taken;
  const TextureResult kept = room.textured(Room::tile_faces),
                      given = reconstructTexture(room.mesh, room.views, options, {},
                                                 [&](const Image&atlas, const Image&) { taken.push_back(atlas); });
  ASSERT_EQ(taken.size(), kept.model.atlases.size());
  for (std::size_t i = 0; i < taken.size(); ++i) {
    EXPECT_EQ(taken[i].data, kept.model.atlases[i].data);
    EXPECT_TRUE(given.model.atlases[i].empty());
    EXPECT_EQ(given.model.atlases[i].width, taken[i].width);
  }
}

TEST(TextureTiles, FacesThatAreThereTwiceAreLeftOut)
{
  Room room;
  const Index faces = room.mesh.faceCount();
  room.mesh.faces.conservativeResize(3, faces + 2);
  room.mesh.faces.rightCols(2) = room.mesh.faces.leftCols(2).eval();
  const TextureResult result = room.textured(Room::tile_faces);
  EXPECT_EQ(result.model.mesh.faceCount(), faces);
  ASSERT_FALSE(result.warnings.empty());
  EXPECT_NE(result.warnings[0].find("2 faces are there twice"), std::string::npos);
}

TEST(TextureTiles, PointsColourThemAsTheWhole)
{
  const Room room;
  PointSet points;
  std::vector<Eigen::Vector3f> places;
  forPlaces(room.mesh, 6, [&](Index f, const Eigen::Vector3d& weights) {
    places.emplace_back(pointAt(room.mesh, f, weights).cast<float>());
  });
  points.points = Eigen::Map<const Points>(places.front().data(), 3, static_cast<Index>(places.size()));
  points.colors.resize(3, points.points.cols());
  for (Index i = 0; i < points.size(); ++i)
    points.colors.col(i) = waves(points.points.col(i).cast<double>()).cast<std::uint8_t>();
  PointTextureOptions options;
  const PointTextureResult whole = reconstructPointTexture(room.mesh, points, options);
  options.tile_faces = Room::tile_faces;
  const PointTextureResult tiles = reconstructPointTexture(room.mesh, points, options);
  EXPECT_GT(tiles.model.atlases.size(), whole.model.atlases.size());
  EXPECT_NEAR(tiles.coverage, whole.coverage, 1e-3);
  double difference = 0, count = 0;
  forPlaces(room.mesh, 10, [&](Index f, const Eigen::Vector3d& weights) {
    difference += (colorAt(tiles.model, f, weights) - colorAt(whole.model, f, weights)).cwiseAbs().mean();
    ++count;
  });
  EXPECT_LT(difference / count, 1);
  const Steps steps = stepsOf(tiles.model, cutIntoTiles(room.mesh, Room::tile_faces));
  std::cout << "points: seams inside tiles " << steps.inside << " grey levels, between tiles " << steps.border << "\n";
  EXPECT_LT(steps.border, 1.2 * steps.inside + 0.2);
}

TEST(TextureTiles, RefuseWhatTheyCannotDo)
{
  const Room room;
  TextureOptions options;
  options.tile_faces = -1;
  EXPECT_THROW(reconstructTexture(room.mesh, room.views, options), std::invalid_argument);
  options.tile_faces = 100;
  TexturedMesh layout;
  layout.mesh = room.mesh;
  EXPECT_THROW(reconstructTexture(layout, room.views, options), std::invalid_argument);
}
} // namespace fresco::test
