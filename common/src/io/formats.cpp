// SPDX-License-Identifier: BSD-3-Clause
// Every format of points and meshes. A new one is a row of the table below and, in docs/formats.md, a row of the list.
#include "io/files/format_table.h"
#include "io/mesh/mesh_formats.h"
#include "io/mesh/obj.h"
#include "io/mesh/ply.h"
#include "io/points/parse_file.h"
#include "io/points/point_formats.h"
#include "io/points/row_file.h"
#include <algorithm>
#include <fresco/io/mesh_io.h>
#include <fresco/io/point_io.h>
#include <numeric>
namespace fresco {
namespace io {
namespace {
template <auto parse>
auto read(const std::string& path)
{
  return parseFile(path, parse);
}

template <auto parse>
PointTable readVertices(const std::string& path)
{
  return parseFile(path, [](std::string_view content) {
    PointTable vertices = parse(content).vertices;
    vertices.own();
    return vertices;
  });
}

template <auto parse>
TriangleMesh readSurface(const std::string& path)
{
  return parseFile(path, [](std::string_view content) {
    auto file = parse(content);
    return tableToMesh(file.vertices, std::move(file.faces));
  });
}

/// For formats that are not compressed.
template <auto write>
void writeRows(const std::string& path, const PointTable& points, bool)
{
  write(path, points);
}

template <auto write>
void writeSurface(const std::string& path, const TriangleMesh& mesh)
{
  write(path, meshToTable(mesh), mesh.faces);
}

void writePlyPoints(const std::string& path, const PointTable& points, bool) { writePly(path, points, Faces()); }

void writePlyMesh(const std::string& path, const TriangleMesh& mesh)
{
  validateMesh(mesh);
  writePly(
      path, mesh.vertexCount(), [&](Index begin, Index end) { return verticesToTable(mesh, begin, end); }, mesh.faces);
}

PointTable readStlPoints(const std::string& path) { return meshToTable(read<parseStl>(path)); }

Format withRows(Format format, std::optional<RowLayout> (*row_layout)(std::string_view))
{
  format.row_layout = row_layout;
  return format;
}

template <auto open>
PointTable readScans(const std::string& path)
{
  return namingFile(path, [&] { return readMergedTable(*open({path})); });
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
} // namespace

const std::vector<Format>& formats()
{
  static const std::vector<Format> all = {
      // name, extensions, points: reads, writes; mesh: reads, writes; with texture
      withRows({"PCD", {".pcd"}, read<parsePcd>, writePcd}, pcdRows),
      withRows({"PLY", {".ply"}, readVertices<parsePly>, writePlyPoints, readSurface<parsePly>, writePlyMesh, true},
               plyRows),
      {"legacy VTK", {".vtk"}, readVertices<parseVtk>, nullptr, readSurface<parseVtk>, writeSurface<writeVtk>},
      {"VTK XML", {".vtp"}, nullptr, nullptr, nullptr, writeSurface<writeVtp>},
      {"STL", {".stl"}, readStlPoints, nullptr, read<parseStl>, writeStl},
      {"OBJ", {".obj"}, readVertices<parseObjMesh>, nullptr, readSurface<parseObjMesh>, writeObj, true},
      {"XYZ", {".xyz", ".txt", ".asc", ".csv"}, read<parseXyz>, writeRows<writeXyz>},
      scansFormat<openE57>("E57", ".e57", writeE57Points),
      scansFormat<openPtx>("PTX", ".ptx"),
      scansFormat<openPts>("PTS", ".pts"),
      scansFormat<openLas>("LAS", ".las", writeRows<writeLas>),
      scansFormat<openLaz>("LAZ", ".laz", writeRows<writeLaz>),
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
std::string formatsThat(FileKind kind, Ability ability)
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

std::string readableExtensions(FileKind kind) { return io::formatsThat(kind, &io::Format::reads); }
std::string writableExtensions(FileKind kind) { return io::formatsThat(kind, &io::Format::writes); }
bool isReadable(const std::string& path, FileKind kind) { return io::find(path, kind, &io::Format::reads) != nullptr; }
bool isWritable(const std::string& path, FileKind kind) { return io::find(path, kind, &io::Format::writes) != nullptr; }

TriangleMesh readMesh(const std::string& path) { return io::formatToRead(path, FileKind::mesh).read_mesh(path); }

void writeMesh(const std::string& path, const TriangleMesh& mesh)
{
  io::formatToWrite(path, FileKind::mesh).write_mesh(path, mesh);
}

PointSet readPoints(const std::string& path)
{
  if (extension(path) == ".ply") // its rows need not be copied before they are converted
    return io::parseFile(path,
                         [](std::string_view content) { return io::tableToPoints(io::parsePly(content).vertices); });
  const io::PointTable table = io::readTable(path);
  return io::namingFile(path, [&] { return io::tableToPoints(table); });
}

void writePoints(const std::string& path, const PointSet& set)
{
  if (extension(path) != ".ply") {
    io::writeTable(path, io::pointsToTable(set));
    return;
  }
  const auto part = [&](Index begin, Index end) {
    std::vector<Index> rows(end - begin);
    std::iota(rows.begin(), rows.end(), begin);
    return io::pointsToTable(selectPoints(set, rows));
  };
  io::writePly(path, set.size(), part, Faces());
}
} // namespace fresco
