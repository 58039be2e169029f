// SPDX-License-Identifier: BSD-3-Clause
#include "simplification/fixed_vertices.h"
#include "tiles/quadtree.h"
#include <cmath>
#include <fresco/core/require.h>
#include <fresco/deliverables/core/detail_baking.h>
#include <fresco/deliverables/core/model_file.h>
#include <fresco/deliverables/core/tileset.h>
#include <fresco/io/file.h>
#include <fresco/io/json_text.h>
#include <nlohmann/json.hpp>
#include <unordered_map>
namespace fresco {
using namespace deliverables;
namespace {
using Json = nlohmann::ordered_json;

/// A tile's surface. Vertices beside other tiles have the number of that of the full mesh, others -1.
struct Part {
  TriangleMesh mesh;
  std::vector<int> shared;
  int levels = 0; ///< of tiles below it
};

class Tiler {
public:
  Tiler(std::string folder, TexturedMesh full, const TilesetOptions& options, const Progress& progress)
      : folder_(std::move(folder)), full_(std::move(full)), options_(options), progress_(progress),
        colored_(isColored(full_)), tree_(quadtreeOf(full_.mesh, options.faces)), tiles_(tree_.quarters.size())
  {
    texel_ = options.texel > 0 ? options.texel : std::max(typicalTexel(full_), 1e-9);
    below_.texcoords = std::move(full_.texcoords);
    below_.atlases = std::move(full_.atlases);
  }

  std::vector<Tile> run()
  {
    make(0);
    return std::move(tiles_);
  }

private:
  bool isShared(int vertex, const Quarter& quarter) const
  {
    return tree_.first_leaf[vertex] < quarter.first || tree_.last_leaf[vertex] > quarter.last;
  }

  /// Makes `below_` the faces of the quarter's leaves. @return Part::shared of its vertices
  std::vector<int> takeBelow(const Quarter& quarter)
  {
    std::vector<int> number(full_.mesh.vertexCount(), -1), vertices, faces, shared;
    for (int leaf = quarter.first; leaf <= quarter.last; ++leaf)
      faces.insert(faces.end(), tree_.leaf_faces[leaf].begin(), tree_.leaf_faces[leaf].end());
    below_.mesh.faces.resize(3, faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f)
      for (int k = 0; k < 3; ++k) {
        const int v = full_.mesh.faces(k, faces[f]);
        if (number[v] < 0) {
          number[v] = int(vertices.size());
          vertices.push_back(v);
          shared.push_back(tree_.first_leaf[v] < tree_.last_leaf[v] ? v : -1);
        }
        below_.mesh.faces(k, f) = number[v];
      }
    below_.mesh.vertices = full_.mesh.vertices(Eigen::all, vertices);
    if (full_.mesh.colors.cols() > 0)
      below_.mesh.colors = full_.mesh.colors(Eigen::all, vertices);
    if (full_.texcoord_faces.cols() > 0) {
      below_.texcoord_faces = full_.texcoord_faces(Eigen::all, faces);
      below_.face_atlas = full_.face_atlas(faces);
    }
    return shared;
  }

  /// Puts parts together at the vertices that they share.
  static Part joined(const std::vector<Part>& parts)
  {
    Part all;
    std::unordered_map<int, int> at;
    std::vector<Eigen::Vector3f> vertices;
    std::vector<Eigen::Vector3i> faces;
    for (const Part& part : parts) {
      all.levels = std::max(all.levels, part.levels + 1);
      std::vector<int> number(part.shared.size());
      for (std::size_t v = 0; v < number.size(); ++v) {
        number[v] = int(vertices.size());
        if (part.shared[v] >= 0)
          number[v] = at.try_emplace(part.shared[v], number[v]).first->second;
        if (number[v] < int(vertices.size()))
          continue;
        vertices.emplace_back(part.mesh.vertices.col(v));
        all.shared.push_back(part.shared[v]);
      }
      for (Index f = 0; f < part.mesh.faceCount(); ++f)
        faces.emplace_back(number[part.mesh.faces(0, f)], number[part.mesh.faces(1, f)], number[part.mesh.faces(2, f)]);
    }
    all.mesh.vertices = Eigen::Map<Points>(vertices[0].data(), 3, vertices.size());
    all.mesh.faces = Eigen::Map<Faces>(faces[0].data(), 3, faces.size());
    return all;
  }

  /// @param error gets what the simplification is off
  Part simplified(Part part, const Quarter& quarter, double& error) const
  {
    std::vector<bool> fixed(part.shared.size());
    Eigen::VectorXf numbers = Eigen::VectorXf::Zero(part.shared.size()); // a field survives where vertices are fixed
    std::vector<int> list;
    for (std::size_t v = 0; v < fixed.size(); ++v)
      if (part.shared[v] >= 0 && isShared(part.shared[v], quarter)) {
        fixed[v] = true;
        list.push_back(part.shared[v]);
        numbers[v] = float(list.size());
      }
    part.mesh.fields.emplace("shared", std::move(numbers));
    SimplificationFigures figures;
    const SimplificationOptions options{options_.faces, 0, options_.threads};
    Part light{simplifyBetween(fixed, std::move(part.mesh), options, figures), {}, part.levels};
    error = figures.error;
    for (const float number : light.mesh.fields["shared"])
      light.shared.push_back(number > 0 ? list[std::size_t(number) - 1] : -1);
    light.mesh.fields.clear();
    return light;
  }

  Part make(int number)
  {
    const Quarter& quarter = tree_.quarters[number];
    Tile& tile = tiles_[number];
    tile.depth = quarter.depth;
    tile.children = quarter.children;
    Part part;
    if (quarter.children.empty()) {
      part.shared = takeBelow(quarter);
      part.mesh.vertices = below_.mesh.vertices;
      part.mesh.faces = below_.mesh.faces;
      write(tile, part.mesh, texel_, number);
      return part;
    }
    std::vector<Part> parts;
    for (const int child : quarter.children) {
      parts.push_back(make(child));
      tile.box.extend(tiles_[child].box);
      tile.error = std::max(tile.error, tiles_[child].error);
    }
    takeBelow(quarter);
    double error = 0;
    part = simplified(joined(parts), quarter, error);
    const double texel = std::ldexp(texel_, part.levels);
    tile.error += error + texel;
    write(tile, part.mesh, texel, number);
    return part;
  }

  void write(Tile& tile, const TriangleMesh& mesh, double texel, int number)
  {
    report(progress_, concat("tile ", written_ + 1, " of ", tiles_.size()), double(written_) / tiles_.size());
    ++written_;
    LightModelOptions options;
    options.texel = texel;
    options.atlases = 1;
    options.threads = options_.threads;
    GltfModel baked = bakeLightModel(mesh, below_, options);
    baked.normal_maps.clear(); // colours are shown as they are
    for (const auto& vertex : mesh.vertices.colwise())
      tile.box.extend(vertex.cast<double>());
    tile.faces = mesh.faceCount();
    tile.file = concat("tile_", number, ".glb");
    GltfOptions gltf; // floats: rounded positions would leave gaps between tiles
    gltf.jpeg_quality = options_.jpeg_quality;
    gltf.lit = !colored_;
    if (!gltf.lit)
      baked.model.mesh.normals.resize(3, 0);
    writeGltf(folder_ + "/" + tile.file, baked, gltf);
  }

  std::string folder_;
  TexturedMesh full_;
  const TilesetOptions& options_;
  const Progress& progress_;
  bool colored_;
  Quadtree tree_;
  std::vector<Tile> tiles_;
  TexturedMesh below_; ///< the part of the full model that a tile stands for, which its texture is baked from
  double texel_;
  std::size_t written_ = 0;
};

Json jsonOf(const std::vector<Tile>& tiles, int number)
{
  const Tile& tile = tiles[number];
  const Eigen::Vector3d c = tile.box.center(), h = (tile.box.sizes() / 2).cwiseMax(1e-6);
  Json json{{"boundingVolume", {{"box", {c.x(), c.y(), c.z(), h.x(), 0, 0, 0, h.y(), 0, 0, 0, h.z()}}}},
            {"geometricError", tile.error},
            {"refine", "REPLACE"},
            {"content", {{"uri", tile.file}}}};
  for (const int child : tile.children)
    json["children"].push_back(jsonOf(tiles, child));
  return json;
}
} // namespace

std::vector<Tile> writeTileset(const std::string& folder, TexturedMesh full, const TilesetOptions& options,
                               const Progress& progress)
{
  require(options.faces >= 1, "tileset: ", options.faces, " faces of a tile");
  require(options.texel >= 0, "tileset: a texel of ", options.texel);
  validateMesh(full.mesh);
  require(full.mesh.faceCount() > 0, "tileset: the model has no faces");
  makeFolder(folder);
  Eigen::Matrix4d T_world_tiles = Eigen::Matrix4d::Identity();
  T_world_tiles.topRightCorner<3, 1>() = full.mesh.origin;
  T_world_tiles = options.T_world_model * T_world_tiles;
  full.mesh.origin.setZero();
  std::vector<Tile> tiles = Tiler(folder, std::move(full), options, progress).run();
  Json root = jsonOf(tiles, 0);
  if (!T_world_tiles.isIdentity(0))
    root["transform"] = std::vector<double>(T_world_tiles.data(), T_world_tiles.data() + 16); // by columns
  const Json all{{"asset", {{"version", "1.1"}, {"generator", "fresco"}}},
                 {"geometricError", tiles[0].box.diagonal().norm()},
                 {"root", root}};
  writeFile(folder + "/tileset.json", jsonText(all, 1));
  report(progress, "done", 1.0);
  return tiles;
}
} // namespace fresco
