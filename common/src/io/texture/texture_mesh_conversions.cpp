// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <fresco/core/pcl_conversions.h>
#include <fresco/core/polygon_fans.h>
#include <fresco/core/require.h>
#include <fresco/io/image_io.h>
#include <fresco/io/texture_mesh_conversions.h>
#include <numeric>
namespace fresco {
namespace {
pcl::TexMaterial material(const std::string& name, const std::string& file)
{
  pcl::TexMaterial result;
  result.tex_name = name;
  result.tex_file = file;
  result.tex_Ka = {0.2f, 0.2f, 0.2f};
  result.tex_Kd = {0.8f, 0.8f, 0.8f};
  result.tex_Ks = {0.f, 0.f, 0.f};
  result.tex_d = 1.f;
  result.tex_Ns = 0.f;
  result.tex_illum = 1;
  return result;
}

/// Appends the faces with atlas `atlas` (-1: without texture) as one sub-mesh.
void addSubMesh(const TexturedMesh& model, int atlas, int& coordinates, pcl::TextureMesh& texture)
{
  auto& polygons = texture.tex_polygons.emplace_back();
  auto& texcoords = texture.tex_coordinates.emplace_back();
  auto& indices = texture.tex_coord_indices.emplace_back();
  for (Index f = 0; f < model.mesh.faceCount(); ++f) {
    if (model.face_atlas[f] != atlas)
      continue;
    auto& corners = polygons.emplace_back().vertices;
    auto& corner_texcoords = indices.emplace_back().vertices;
    for (int k = 0; k < 3; ++k) {
      corners.push_back(model.mesh.faces(k, f));
      if (atlas < 0)
        continue;
      texcoords.push_back(model.texcoords.col(model.texcoord_faces(k, f)));
      corner_texcoords.push_back(coordinates++);
    }
  }
}

struct TexturedFaces {
  std::vector<Eigen::Vector2f> texcoords; ///< of all sub-meshes
  std::vector<int> corners, atlases;      ///< 3 and 1 per triangle, in the order of toTriangleMesh()
};

/// @param corners of a polygon, indices into all texture coordinates; empty where it has no texture
void addPolygon(const std::vector<int>& corners, std::size_t count, int atlas, TexturedFaces& faces)
{
  require(corners.empty() || corners.size() == count, "texture mesh: a polygon with ", count, " corners has ",
          corners.size(), " texture coordinates");
  core::triangulate(count, [&](std::size_t a, std::size_t b, std::size_t c) {
    faces.atlases.push_back(corners.empty() ? -1 : atlas);
    for (const std::size_t k : {a, b, c})
      faces.corners.push_back(corners.empty() ? -1 : corners[k]);
  });
}

TexturedFaces collectFaces(const pcl::TextureMesh& texture)
{
  TexturedFaces faces;
  for (const auto& part : texture.tex_coordinates)
    faces.texcoords.insert(faces.texcoords.end(), part.begin(), part.end());
  int first = 0; // texture coordinate of the sub-mesh
  for (std::size_t part = 0; part < texture.tex_polygons.size(); ++part) {
    const int texcoords = part < texture.tex_coordinates.size() ? texture.tex_coordinates[part].size() : 0;
    int next = first;
    for (std::size_t p = 0; p < texture.tex_polygons[part].size(); ++p) {
      const std::size_t count = texture.tex_polygons[part][p].vertices.size();
      std::vector<int> corners(texcoords > 0 ? count : 0);
      std::iota(corners.begin(), corners.end(), next);
      next += count;
      if (part < texture.tex_coord_indices.size() && p < texture.tex_coord_indices[part].size()) {
        const auto& indices = texture.tex_coord_indices[part][p].vertices;
        corners.assign(indices.begin(), indices.end());
      }
      addPolygon(corners, count, part, faces);
    }
    first += texcoords;
  }
  for (const int index : faces.corners)
    require(index >= -1 && index < Index(faces.texcoords.size()), "texture mesh: texture coordinate ", index,
            " is not there");
  return faces;
}

std::vector<Image> readAtlases(const pcl::TextureMesh& texture, const std::string& folder)
{
  std::vector<Image> images;
  for (std::size_t part = 0; part < texture.tex_polygons.size(); ++part) {
    const std::string file = part < texture.tex_materials.size() ? texture.tex_materials[part].tex_file : "";
    images.push_back(file.empty() ? Image() : readImage((std::filesystem::path(folder) / file).string()));
  }
  return images;
}
} // namespace

void toTextureMesh(const TexturedMesh& model, pcl::TextureMesh& texture, const std::vector<std::string>& image_files)
{
  validateTexturedMesh(model);
  require(image_files.empty() || image_files.size() == model.atlases.size(), "texture mesh: ", image_files.size(),
          " names for ", model.atlases.size(), " images");
  TriangleMesh mesh = model.mesh;
  if (mesh.normals.cols() == 0)
    mesh.normals = vertexNormals(mesh);
  pcl::PolygonMesh polygons;
  polygons.cloud.header = texture.cloud.header;
  toPolygonMesh(mesh, polygons);
  const pcl::PCLHeader header = texture.header;
  texture = pcl::TextureMesh();
  texture.header = header;
  texture.cloud = std::move(polygons.cloud);
  int coordinates = 0;
  for (std::size_t i = 0; i < model.atlases.size(); ++i) {
    addSubMesh(model, i, coordinates, texture);
    texture.tex_materials.push_back(
        material(concat("material_", i), image_files.empty() ? concat("texture_", i, ".png") : image_files[i]));
  }
  if ((model.face_atlas.array() < 0).any()) {
    addSubMesh(model, -1, coordinates, texture);
    texture.tex_materials.push_back(material("untextured", ""));
  }
}

TexturedMesh toTexturedMesh(const pcl::TextureMesh& texture, const std::string& folder, std::vector<Image> atlases)
{
  require(atlases.empty() || atlases.size() == texture.tex_polygons.size(), "texture mesh: ", atlases.size(),
          " images for ", texture.tex_polygons.size(), " sub-meshes");
  pcl::PolygonMesh polygons;
  polygons.cloud = texture.cloud;
  for (const auto& part : texture.tex_polygons)
    polygons.polygons.insert(polygons.polygons.end(), part.begin(), part.end());
  const TexturedFaces faces = collectFaces(texture);
  TexturedMesh model;
  model.mesh = toTriangleMesh(polygons);
  model.texcoord_faces = Eigen::Map<const Eigen::Matrix3Xi>(faces.corners.data(), 3, model.mesh.faceCount());
  model.face_atlas = Eigen::Map<const Eigen::VectorXi>(faces.atlases.data(), model.mesh.faceCount());
  model.texcoords.resize(2, faces.texcoords.size());
  for (Index i = 0; i < model.texcoords.cols(); ++i)
    model.texcoords.col(i) = faces.texcoords[i];
  model.atlases = atlases.empty() ? readAtlases(texture, folder) : std::move(atlases);
  while (!model.atlases.empty() && model.atlases.back().empty() &&
         (model.face_atlas.array() < static_cast<int>(model.atlases.size()) - 1).all())
    model.atlases.pop_back();
  return model;
}
} // namespace fresco
