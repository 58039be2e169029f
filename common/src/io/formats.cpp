// SPDX-License-Identifier: BSD-3-Clause
// Every format of points and meshes. A new one is a row of the table below and, in docs/formats.md, a row of the list.
#include "io/files/format_table.h"
#include "io/mesh/obj.h"
#include "io/mesh/ply.h"
#include "io/mesh/stl.h"
#include "io/mesh/vtk_file.h"
#include "io/points/e57/e57.h"
#include "io/points/las.h"
#include "io/points/parse_file.h"
#include "io/points/pcd.h"
#include "io/points/row_file.h"
#include "io/points/text_scans.h"
#include "io/points/xyz.h"
#include <algorithm>
#include <fresco/core/pcl_cloud_table.h>
#include <fresco/io/mesh_io.h>
#include <fresco/io/scan_writer.h>
#include <pcl/PCLPointCloud2.h>
namespace fresco {
namespace io {
namespace {
TriangleMesh joinMesh(const PointTable& vertices, Faces faces)
{
  TriangleMesh mesh = tableToMesh(vertices);
  mesh.faces = std::move(faces);
  return mesh;
}

PointTable readPcd(const std::string& path) { return parseFile(path, parsePcd); }

PointTable readPlyPoints(const std::string& path)
{
  return parseFile(path, [](std::string_view content) {
    PointTable vertices = parsePly(content).vertices;
    vertices.own();
    return vertices;
  });
}

void writePlyPoints(const std::string& path, const PointTable& points, bool) { writePly(path, points, Faces()); }

TriangleMesh readPlyMesh(const std::string& path)
{
  return parseFile(path, [](std::string_view content) {
    PlyContent ply = parsePly(content);
    return joinMesh(ply.vertices, std::move(ply.faces));
  });
}

void writePlyMesh(const std::string& path, const TriangleMesh& mesh)
{
  validateMesh(mesh);
  writePly(
      path, mesh.vertexCount(), [&](Index begin, Index end) { return verticesToTable(mesh, begin, end); }, mesh.faces);
}

PointTable readVtkPoints(const std::string& path)
{
  return parseFile(path, [](std::string_view content) { return parseVtk(content).vertices; });
}

TriangleMesh readVtkMesh(const std::string& path)
{
  return parseFile(path, [](std::string_view content) {
    VtkContent vtk = parseVtk(content);
    return joinMesh(vtk.vertices, std::move(vtk.faces));
  });
}

void writeVtkMesh(const std::string& path, const TriangleMesh& mesh) { writeVtk(path, meshToTable(mesh), mesh.faces); }

void writeVtpMesh(const std::string& path, const TriangleMesh& mesh) { writeVtp(path, meshToTable(mesh), mesh.faces); }

TriangleMesh readStlMesh(const std::string& path) { return parseFile(path, parseStl); }
PointTable readStlPoints(const std::string& path) { return meshToTable(readStlMesh(path)); }

PointTable readObjPoints(const std::string& path)
{
  return parseFile(path, [](std::string_view content) { return objVertices(parseObj(content)); });
}

TriangleMesh readObjMesh(const std::string& path)
{
  return parseFile(path, [](std::string_view content) {
    const ObjContent obj = parseObj(content);
    return joinMesh(objVertices(obj), objFaces(obj));
  });
}

PointTable readXyz(const std::string& path) { return parseFile(path, parseXyz); }
void writeXyzPoints(const std::string& path, const PointTable& points, bool) { writeXyz(path, points); }

Format withRows(Format format, std::optional<RowLayout> (*row_layout)(std::string_view))
{
  format.row_layout = row_layout;
  return format;
}

template <auto open>
PointTable readScans(const std::string& path)
{
  return namingFile(path, [&] { return readMergedTable(*open(path)); });
}

/// A format of several scans.
template <auto open>
Format scansFormat(const char* name, const char* extension,
                   void (*write)(const std::string&, const PointTable&, bool) = nullptr)
{
  Format format{name, {extension}, readScans<open>, write};
  format.open_scans = open;
  return format;
}

void writeLasPoints(const std::string& path, const PointTable& points, bool) { writeLas(path, points); }
void writeLazPoints(const std::string& path, const PointTable& points, bool) { writeLaz(path, points); }

/// One scan, in the frame of its sensor where that is known.
void writeE57Points(const std::string& path, const PointTable& points, bool)
{
  PlacedCloud scan{"scan 1", {}, {}};
  PointTable table = points;
  if (points.sensor) {
    scan.T_file_scan = Eigen::Isometry3d(Eigen::Translation3d(points.sensor->position));
    moveOrigin(table, points.sensor->position);
  }
  scan.cloud.cloud = cloudOfTable(std::move(table));
  writeScans(path, {scan});
}
} // namespace

const std::vector<Format>& formats()
{
  static const std::vector<Format> all = {
      // name, extensions, points: reads, writes; mesh: reads, writes; with texture
      withRows({"PCD", {".pcd"}, readPcd, writePcd}, pcdRows),
      withRows({"PLY", {".ply"}, readPlyPoints, writePlyPoints, readPlyMesh, writePlyMesh, true}, plyRows),
      {"legacy VTK", {".vtk"}, readVtkPoints, nullptr, readVtkMesh, writeVtkMesh},
      {"VTK XML", {".vtp"}, nullptr, nullptr, nullptr, writeVtpMesh},
      {"STL", {".stl"}, readStlPoints, nullptr, readStlMesh, writeStl},
      {"OBJ", {".obj"}, readObjPoints, nullptr, readObjMesh, writeObj, true},
      {"XYZ", {".xyz", ".txt", ".asc", ".csv"}, readXyz, writeXyzPoints},
      scansFormat<openE57>("E57", ".e57", writeE57Points),
      scansFormat<openPtx>("PTX", ".ptx"),
      scansFormat<openPts>("PTS", ".pts"),
      scansFormat<openLas>("LAS", ".las", writeLasPoints),
      scansFormat<openLaz>("LAZ", ".laz", writeLazPoints),
      {"binary glTF", {".glb"}, nullptr, nullptr, nullptr, nullptr, true},
  };
  return all;
}

bool Format::reads(FileKind kind) const
{
  return kind == FileKind::points ? read_points != nullptr : kind == FileKind::mesh ? read_mesh != nullptr : textured;
}

bool Format::writes(FileKind kind) const
{
  return kind == FileKind::points ? write_points != nullptr : kind == FileKind::mesh ? write_mesh != nullptr : textured;
}

namespace {
using Ability = bool (Format::*)(FileKind) const;

const char* nameOf(FileKind kind)
{
  return kind == FileKind::points ? "file of points" : kind == FileKind::mesh ? "mesh file" : "textured model";
}

/// ".a, .b or .c" of the formats that have the ability.
std::string listOf(FileKind kind, Ability ability)
{
  std::vector<std::string> all;
  for (const Format& format : formats())
    if ((format.*ability)(kind))
      all.insert(all.end(), format.extensions.begin(), format.extensions.end());
  std::string text;
  for (std::size_t i = 0; i < all.size(); ++i)
    text += (i == 0 ? "" : i + 1 == all.size() ? " or " : ", ") + all[i];
  return text;
}

const Format* find(const std::string& path, FileKind kind, Ability ability)
{
  const std::string type = extension(path);
  for (const Format& format : formats())
    if ((format.*ability)(kind) && std::count(format.extensions.begin(), format.extensions.end(), type) > 0)
      return &format;
  return nullptr;
}
} // namespace

const Format& formatToRead(const std::string& path, FileKind kind)
{
  if (const Format* const format = find(path, kind, &Format::reads))
    return *format;
  throw std::runtime_error(path + ": not a " + nameOf(kind) + ": expected " + readableExtensions(kind));
}

const Format& formatToWrite(const std::string& path, FileKind kind)
{
  if (const Format* const format = find(path, kind, &Format::writes))
    return *format;
  throw std::runtime_error(path + ": cannot write this type of " + nameOf(kind) + ": use " + writableExtensions(kind));
}

PointTable readTable(const std::string& path)
{
  PointTable table = formatToRead(path, FileKind::points).read_points(path);
  normalizeColors(table);
  return table;
}

void writeTable(const std::string& path, const PointTable& table, bool compressed)
{
  formatToWrite(path, FileKind::points).write_points(path, table, compressed);
}
} // namespace io

std::string readableExtensions(FileKind kind) { return io::listOf(kind, &io::Format::reads); }
std::string writableExtensions(FileKind kind) { return io::listOf(kind, &io::Format::writes); }
bool isReadable(const std::string& path, FileKind kind) { return io::find(path, kind, &io::Format::reads) != nullptr; }
bool isWritable(const std::string& path, FileKind kind) { return io::find(path, kind, &io::Format::writes) != nullptr; }

TriangleMesh readMesh(const std::string& path) { return io::formatToRead(path, FileKind::mesh).read_mesh(path); }

void writeMesh(const std::string& path, const TriangleMesh& mesh)
{
  io::formatToWrite(path, FileKind::mesh).write_mesh(path, mesh);
}
} // namespace fresco
