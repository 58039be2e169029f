// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <fresco/core/export.h>
#include <fresco/core/point_table.h>
#include <fresco/io/file.h>
#include <string>
#include <string_view>
#include <vector>
namespace fresco::io {
struct ObjTriangle {
  std::array<int, 3> vertices;
  std::array<int, 3> texcoords; ///< -1 where there is none
  std::array<int, 3> normals;   ///< -1 where there is none
  int material;                 ///< index into ObjContent::materials, -1 before the first usemtl
};

struct ObjContent {
  std::vector<double> vertices; ///< x y z each
  std::vector<double> colors;   ///< r g b of each vertex as in the file; empty: there are none
  std::vector<double> normals;  ///< x y z each
  std::vector<float> texcoords; ///< u v each
  std::vector<ObjTriangle> triangles;
  std::vector<std::string> materials; ///< names in the order of their first use
  std::vector<std::string> libraries; ///< files named by mtllib

  Index vertexCount() const { return vertices.size() / 3; }
};

/// Polygons become fans. @throws std::runtime_error if malformed, without vertices, or if an index is out of range
FRESCO_EXPORT ObjContent parseObj(std::string_view content);

/// Vertices with colours and one normal each: the normals of a vertex's corners, added up where they differ.
FRESCO_EXPORT MeshTable objMesh(const ObjContent& content);
MeshTable parseObjMesh(std::string_view content);

/// Image that each material of a .mtl file names by map_Kd, material by material.
FRESCO_EXPORT std::vector<std::pair<std::string, std::string>> parseMtl(std::string_view content);

/// `v` lines (with colours) and `vn` lines.
FRESCO_EXPORT void writeObjVertices(OutputFile& file, const TriangleMesh& mesh);

/// The `f` line of a face. @param texcoords of its corners; null: none
FRESCO_EXPORT void writeObjFace(OutputFile& file, const TriangleMesh& mesh, Index f, const int* texcoords = nullptr);

/// Vertices and faces.
void writeObj(const std::string& path, const TriangleMesh& mesh);
} // namespace fresco::io
