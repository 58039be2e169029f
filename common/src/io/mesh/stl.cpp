// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/mesh_formats.h"
#include "io/mesh/vtk_arrays.h"
#include "io/points/text_numbers.h"
#include <algorithm>
#include <cmath>
#include <fresco/io/file.h>
#include <limits>
#include <numeric>
namespace fresco::io {
namespace {
constexpr std::size_t header_size = 84;   // bytes of a binary file: a title, then the count of triangles
constexpr std::size_t title_size = 80;    // bytes
constexpr std::size_t triangle_size = 50; // bytes: normal, three corners, two bytes more

bool isText(std::string_view content)
{
  return lowerCase(content.substr(0, 5)) == "solid" && content.find('\0') == std::string_view::npos;
}

/// Coordinates of the corners, three numbers each, three corners a triangle.
using Corners = std::vector<double>;

Corners binaryCorners(std::string_view content)
{
  const std::size_t room = content.size() < header_size ? 0 : (content.size() - header_size) / triangle_size;
  const std::size_t count = content.size() < header_size ? 1 : loadScalar<std::uint32_t>(&content[title_size]);
  expect(count <= room, "truncated: the triangles do not fit into the file");
  Corners corners(9 * count);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::size_t normal = 3 * sizeof(float);
    corners[i] = loadScalar<float>(&content[header_size + i / 9 * triangle_size + normal + i % 9 * sizeof(float)]);
  }
  return corners;
}

Corners textCorners(std::string_view content)
{
  TextScanner scanner(content);
  Corners corners;
  bool closed = false;
  while (true) {
    while (scanner.atLineEnd() && !scanner.done())
      scanner.nextLine();
    if (scanner.done())
      break;
    const std::string word = lowerCase(scanner.word());
    if (word == "solid" || word == "endsolid") {
      closed = word == "endsolid";
      scanner.restOfLine(); // its name
    } else if (word == "facet") {
      for (int i = 0; i < 4; ++i) // "normal" and its coordinates, which follow from the corners
        scanner.wordAcrossLines();
    } else if (word == "vertex") {
      for (int i = 0; i < 3; ++i)
        corners.push_back(parseNumber<double>(scanner.wordAcrossLines()));
    } else if (word == "endloop") {
      expect(!corners.empty() && corners.size() % 9 == 0, "line ", scanner.line(), ": a facet without three corners");
    } else if (word != "outer" && word != "loop" && word != "endfacet") {
      throw std::runtime_error(concat("line ", scanner.line(), ": unknown word '", word.substr(0, 40), "'"));
    }
  }
  expect(closed && corners.size() % 9 == 0, "truncated: the last line is not 'endsolid'");
  return corners;
}

/// Bytes of face `f`: its unit normal, its corners, no attribute.
std::string triangleBytes(const TriangleMesh& mesh, Index f)
{
  Eigen::Matrix<float, 3, 4> row;
  const Eigen::Vector3d normal = areaVector(mesh, f);
  const double length = normal.norm();
  row.col(0) = (length > 0 ? Eigen::Vector3d(normal / length) : Eigen::Vector3d::Zero()).cast<float>();
  for (int k = 0; k < 3; ++k)
    row.col(k + 1) = (mesh.origin + faceCorner(mesh, f, k)).cast<float>();
  std::string bytes(triangle_size, '\0');
  std::memcpy(bytes.data(), row.data(), sizeof(row));
  return bytes;
}
} // namespace

TriangleMesh parseStl(std::string_view content)
{
  const Corners corners = isText(content) ? textCorners(content) : binaryCorners(content);
  expect(std::all_of(corners.begin(), corners.end(), [](double value) { return std::isfinite(value); }),
         "a coordinate is not finite");
  expect(corners.size() / 3 <= std::numeric_limits<int>::max(), "more than ", std::numeric_limits<int>::max(),
         " corners");
  TriangleMesh mesh = tableToMesh(tableOfRows({std::begin(xyz_names), std::end(xyz_names)}, corners));
  mesh.faces.resize(3, mesh.vertexCount() / 3);
  std::iota(mesh.faces.data(), mesh.faces.data() + mesh.faces.size(), 0);
  const Faces welded = weldedFaces(mesh);
  std::vector<Index> kept;
  for (Index f = 0; f < welded.cols(); ++f)
    if (const auto face = welded.col(f); face[0] != face[1] && face[1] != face[2] && face[0] != face[2])
      kept.push_back(f);
  expect(!kept.empty(), "no triangles");
  mesh.faces = welded(Eigen::all, kept);
  return removeUnreferencedVertices(mesh);
}

void writeStl(const std::string& path, const TriangleMesh& mesh)
{
  validateMesh(mesh);
  expect(mesh.faceCount() != 0 && mesh.faceCount() <= std::numeric_limits<std::uint32_t>::max(), path,
         ": STL has no place for ", mesh.faceCount(), " faces");
  OutputFile file(path);
  std::string header(header_size, '\0');
  header.replace(0, 10, "STL fresco");
  const std::uint32_t count = mesh.faceCount();
  std::memcpy(&header[title_size], &count, sizeof(count));
  file.write(header);
  for (Index f = 0; f < mesh.faceCount(); ++f)
    file.write(triangleBytes(mesh, f));
  file.commit();
}
} // namespace fresco::io
