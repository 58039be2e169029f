// SPDX-License-Identifier: BSD-3-Clause
#include "deliverables/models.h"
#include "test_data.h"
#include <algorithm>
#include <array>
#include <filesystem>
#include <fresco/deliverables/core/tileset.h>
#include <fresco/io/file.h>
#include <fresco/io/mesh_io.h>
#include <functional>
#include <gtest/gtest.h>
#include <map>
#include <nlohmann/json.hpp>
namespace {
using namespace fresco;

/// A closed surface with colours, far from the origin.
TexturedMesh planet()
{
  TexturedMesh model;
  model.mesh = test::sphere(1, 5);
  model.mesh.origin = {500000, 5200000, 300};
  model.mesh.colors.resize(3, model.mesh.vertexCount());
  for (Index v = 0; v < model.mesh.vertexCount(); ++v)
    for (int k = 0; k < 3; ++k)
      model.mesh.colors(k, v) = std::uint8_t(120 + 80 * model.mesh.vertices(k, v));
  return model;
}

struct Written {
  std::string folder = test::scratchFolder();
  TexturedMesh full = planet();
  std::vector<Tile> tiles;

  Written()
  {
    TilesetOptions options;
    options.faces = 900;
    tiles = writeTileset(folder, full, options);
  }

  TriangleMesh read(const Tile& tile) const { return readTexturedMesh(folder + "/" + tile.file).mesh; }
};

/// Corners of faces with exact coordinates, each starting with its least one.
using Corner = std::array<float, 3>;
std::vector<std::array<Corner, 3>> facesOf(const std::vector<TriangleMesh>& meshes)
{
  std::vector<std::array<Corner, 3>> all;
  for (const TriangleMesh& mesh : meshes)
    for (Index f = 0; f < mesh.faceCount(); ++f) {
      std::array<Corner, 3> face;
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d p = faceCorner(mesh, f, k) + mesh.origin;
        face[k] = {float(p.x()), float(p.y()), float(p.z())};
      }
      std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
      all.push_back(face);
    }
  std::sort(all.begin(), all.end());
  return all;
}

/// Edges of faces that have no partner in the other direction.
Index openEdges(const std::vector<TriangleMesh>& meshes)
{
  std::map<std::pair<Corner, Corner>, int> balance;
  for (const auto& face : facesOf(meshes))
    for (int k = 0; k < 3; ++k) {
      const Corner &a = face[k], &b = face[(k + 1) % 3];
      a < b ? ++balance[{a, b}] : --balance[{b, a}];
    }
  return std::count_if(balance.begin(), balance.end(), [](const auto& edge) { return edge.second != 0; });
}

TEST(Tileset, TheFinestTilesHaveEachFaceOnce)
{
  const Written written;
  std::vector<TriangleMesh> finest;
  for (const Tile& tile : written.tiles)
    if (tile.children.empty())
      finest.push_back(written.read(tile));
  TriangleMesh full = written.full.mesh;
  full.origin.setZero();
  EXPECT_EQ(facesOf(finest), facesOf({full}));
  EXPECT_GT(finest.size(), 8u);
}

TEST(Tileset, BoxesHoldWhatIsBelowAndErrorsFall)
{
  const Written written;
  for (const Tile& tile : written.tiles) {
    Eigen::AlignedBox3d box = tile.box;
    for (const int child : tile.children) {
      EXPECT_TRUE(box.contains(written.tiles[child].box));
      EXPECT_LT(written.tiles[child].error, tile.error);
      EXPECT_EQ(written.tiles[child].depth, tile.depth + 1);
    }
    box.min().array() -= 1e-6;
    box.max().array() += 1e-6;
    const TriangleMesh mesh = written.read(tile);
    for (Index v = 0; v < mesh.vertexCount(); ++v)
      EXPECT_TRUE(box.contains(mesh.origin + mesh.vertices.col(v).cast<double>()));
    EXPECT_EQ(mesh.faceCount(), tile.faces);
    EXPECT_EQ(tile.error > 0, !tile.children.empty());
  }
  EXPECT_LT(written.tiles[0].faces, written.full.mesh.faceCount() / 4);
}

TEST(Tileset, TilesOfAnyLevelsMeetWithoutGaps)
{
  const Written written;
  for (int pattern = 0; pattern < 16; ++pattern) { // which quarters are refined by how much
    std::vector<TriangleMesh> shown;
    const std::function<void(int, int)> show = [&](int number, int depth) {
      const Tile& tile = written.tiles[number];
      if (tile.children.empty() || depth <= 0)
        return shown.push_back(written.read(tile));
      for (std::size_t k = 0; k < tile.children.size(); ++k)
        show(tile.children[k], depth - 1 - ((pattern >> k) & 1));
    };
    show(0, 3);
    EXPECT_EQ(openEdges(shown), 0) << pattern;
  }
}

TEST(Tileset, TheFileTellsTheTilesAndTheirPlace)
{
  const Written written;
  const auto json = nlohmann::json::parse(readFile(written.folder + "/tileset.json"));
  EXPECT_EQ(json["asset"]["version"], "1.1");
  EXPECT_GT(json["geometricError"].get<double>(), json["root"]["geometricError"].get<double>());
  EXPECT_EQ(json["root"]["transform"][12], 500000);
  std::size_t count = 0;
  const std::function<void(const nlohmann::json&)> visit = [&](const nlohmann::json& tile) {
    ++count;
    EXPECT_TRUE(std::filesystem::exists(written.folder + "/" + tile["content"]["uri"].get<std::string>()));
    for (const auto& child : tile.value("children", nlohmann::json::array()))
      visit(child);
  };
  visit(json["root"]);
  EXPECT_EQ(count, written.tiles.size());
}

TEST(Tileset, DoesNotDependOnThreadsAndRefusesNonsense)
{
  const std::string folder = test::scratchFolder();
  TilesetOptions options;
  options.faces = 3000;
  const TexturedMesh model = planet();
  for (const int threads : {1, 4}) {
    options.threads = threads;
    writeTileset(folder + "/" + std::to_string(threads), model, options);
  }
  for (const char* name : {"/tileset.json", "/tile_0.glb", "/tile_1.glb"})
    EXPECT_EQ(readFile(folder + "/1" + name), readFile(folder + "/4" + name)) << name;
  options.faces = 0;
  EXPECT_THROW(writeTileset(folder, model, options), std::invalid_argument);
  EXPECT_THROW(writeTileset(folder, {}), std::invalid_argument);
}
} // namespace
