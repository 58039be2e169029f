// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/obj.h"
#include "io/mesh/ply.h"
#include "io/mesh/vtk_file.h"
#include "io/points/parse_file.h"
#include "io/points/pcd.h"
#include "io/points/xyz.h"
#include <fresco/io/point_io.h>
namespace fresco {
namespace {
/// Points begin .. end - 1.
PointSet pointsBetween(const PointSet& set, Index begin, Index end)
{
  const auto part = [&](const auto& all) {
    return all.middleCols(all.cols() > 0 ? begin : 0, all.cols() > 0 ? end - begin : 0);
  };
  PointSet result;
  result.origin = set.origin;
  result.points = part(set.points);
  result.normals = part(set.normals);
  result.colors = part(set.colors);
  if (set.intensities.size() > 0)
    result.intensities = set.intensities.segment(begin, end - begin);
  if (set.confidences.size() > 0)
    result.confidences = set.confidences.segment(begin, end - begin);
  if (set.viewpoints.cols() == 1)
    result.viewpoints = set.viewpoints;
  else
    result.viewpoints = part(set.viewpoints);
  return result;
}

bool isTextCloud(const std::string& type) { return type == ".xyz" || type == ".txt" || type == ".asc"; }
} // namespace

namespace io {
PointTable readTable(const std::string& path)
{
  const std::string type = extension(path);
  if (type == ".pcd")
    return parseFile(path, parsePcd);
  if (type == ".ply")
    return parseFile(path, [](std::string_view content) {
      PointTable vertices = parsePly(content).vertices;
      vertices.own();
      return vertices;
    });
  if (type == ".vtk")
    return parseFile(path, [](std::string_view content) { return parseVtk(content).vertices; });
  if (type == ".obj")
    return parseFile(path, [](std::string_view content) { return objVertices(parseObj(content)); });
  if (isTextCloud(type))
    return parseFile(path, parseXyz);
  throw std::runtime_error(path + ": not a file of points: expected .pcd, .ply, .vtk, .obj, .xyz, .txt or .asc");
}

void writeTable(const std::string& path, const PointTable& table, bool compressed)
{
  const std::string type = extension(path);
  if (type == ".pcd")
    writePcd(path, table, compressed);
  else if (type == ".ply")
    writePly(path, table, Faces());
  else if (isTextCloud(type))
    writeXyz(path, table);
  else
    throw std::runtime_error(path + ": cannot write this type of file of points: use .pcd, .ply or .xyz");
}
} // namespace io

PointSet readPoints(const std::string& path)
{
  if (extension(path) == ".ply") // its rows need not be copied before they are converted
    return io::parseFile(path,
                         [](std::string_view content) { return io::tableToPoints(io::parsePly(content).vertices); });
  const io::PointTable table = io::readTable(path);
  try {
    return io::tableToPoints(table);
  } catch (const std::exception& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
}

void writePoints(const std::string& path, const PointSet& set)
{
  if (extension(path) != ".ply") {
    io::writeTable(path, io::pointsToTable(set));
    return;
  }
  validatePointSet(set);
  io::writePly(path, set.size(),
               [&](Index begin, Index end) { return io::pointsToTable(pointsBetween(set, begin, end)); });
}
} // namespace fresco
