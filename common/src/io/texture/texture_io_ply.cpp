// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/ply.h"
#include "io/points/parse_file.h"
#include "io/texture/texture_io.h"
#include <filesystem>
#include <fresco/io/image_io.h>
#include <fresco/io/ply_rows.h>
namespace fresco::io {
namespace {
constexpr Index faces_per_write = Index{1} << 16;

/// Columns of texture coordinates of the vertices; nothing if there are none.
std::optional<std::array<Column, 2>> texcoordColumns(const PointTable& vertices)
{
  constexpr const char* names[][2] = {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}};
  for (const auto& [u, v] : names)
    if (const Column* first = vertices.find(u), *second = vertices.find(v); first && second)
      return std::array<Column, 2>{*first, *second};
  return {};
}

/// Texture coordinates of the vertices, which the mesh then has no fields of.
void takeVertexTexcoords(const PointTable& vertices, const std::array<Column, 2>& columns, TexturedMesh& model)
{
  model.texcoords.resize(2, vertices.rows);
  for (int axis = 0; axis < 2; ++axis) {
    model.texcoords.row(axis) = columnValues(vertices, columns[axis]);
    model.mesh.fields.erase(columns[axis].name);
  }
  model.texcoord_faces = model.mesh.faces;
}

/// Texture coordinates of the corners of each face.
void takeFaceTexcoords(const PlyContent& ply, TexturedMesh& model)
{
  const Index corners = ply.texcoords.size() / 2;
  expect(corners == model.mesh.faces.size(), "texture coordinates beside triangle strips");
  model.texcoords = Eigen::Map<const Eigen::Matrix2Xf>(ply.texcoords.data(), 2, corners);
  for (Index i = 0; i < corners; ++i)
    model.texcoord_faces.data()[i] = int(i);
}
} // namespace

TexturedMesh readTexturedPly(const std::string& path)
{
  return parseFile(path, [&](std::string_view content) {
    PlyContent ply = parseTexturedPly(content);
    TexturedMesh read;
    read.mesh = tableToMesh(ply.vertices, std::move(ply.faces));
    read.texcoord_faces.setConstant(3, read.mesh.faceCount(), -1);
    read.face_atlas = Eigen::VectorXi::Constant(read.mesh.faceCount(), -1);
    if (ply.textures.empty()) // no comment TextureFile: a mesh
      return read;
    if (const auto columns = texcoordColumns(ply.vertices))
      takeVertexTexcoords(ply.vertices, *columns, read);
    else
      takeFaceTexcoords(ply, read);
    for (Index f = 0; f < read.mesh.faceCount(); ++f) {
      const int number = std::size_t(f) < ply.texnumbers.size() ? ply.texnumbers[f] : 0;
      bool textured = number >= 0 && std::size_t(number) < ply.textures.size();
      for (int k = 0; k < 3; ++k)
        textured = textured && read.texcoords.col(read.texcoord_faces(k, f)).allFinite();
      read.face_atlas[f] = textured ? number : -1;
      if (!textured)
        read.texcoord_faces.col(f).setConstant(-1);
    }
    read.texcoords = read.texcoords.array().isFinite().select(read.texcoords, 0.f);
    const std::string folder = std::filesystem::path(path).parent_path().string();
    for (const std::string& name : ply.textures)
      read.atlases.push_back(readImage(fileBelow(folder, portablePath(name))));
    return read;
  });
}

void writeTexturedPly(OutputFile& file, const TexturedMesh& model, const std::vector<std::string>& images)
{
#pragma pack(push, 1)
  struct Row {
    std::uint8_t corner_count = 3;
    int corners[3];
    std::uint8_t value_count = 6;
    float texcoords[6];
    int texnumber;
  };
#pragma pack(pop)
  const PointTable vertices = plyRows(meshToTable(model.mesh));
  std::string header = plyHeader(vertices, vertices.rows, model.mesh.faceCount());
  std::string comments;
  for (const std::string& image : images)
    comments += "comment TextureFile " + image + "\n";
  header.insert(header.find("element"), comments);
  const std::string end = "end_header\n";
  if (model.mesh.faceCount() > 0)
    header.replace(header.size() - end.size(), end.size(),
                   "property list uchar float texcoord\nproperty int texnumber\n" + end);
  file.write(header);
  file.write(vertices.data.data(), vertices.data.size());
  std::vector<Row> rows;
  for (Index f = 0; f < model.mesh.faceCount(); ++f) {
    Row row{};
    row.texnumber = model.face_atlas[f];
    for (int k = 0; k < 3; ++k) {
      row.corners[k] = model.mesh.faces(k, f);
      for (int axis = 0; axis < 2 && row.texnumber >= 0; ++axis)
        row.texcoords[2 * k + axis] = model.texcoords(axis, model.texcoord_faces(k, f));
    }
    rows.push_back(row);
    if (Index(rows.size()) == faces_per_write || f + 1 == model.mesh.faceCount()) {
      file.write(rows.data(), rows.size() * sizeof(Row));
      rows.clear();
    }
  }
}
} // namespace fresco::io
