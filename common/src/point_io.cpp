// SPDX-License-Identifier: BSD-3-Clause
#include "obj.h"
#include "pcd.h"
#include "ply.h"
#include "point_io_parse.h"
#include "vtk_file.h"
#include "xyz.h"
#include <fresco/common/point_io.h>
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

namespace detail {
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
} // namespace detail

PointSet readPoints(const std::string& path)
{
  if (extension(path) == ".ply") // its rows need not be copied before they are converted
    return detail::parseFile(
        path, [](std::string_view content) { return detail::tableToPoints(detail::parsePly(content).vertices); });
  const detail::PointTable table = detail::readTable(path);
  try {
    return detail::tableToPoints(table);
  } catch (const std::exception& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
}

void writePoints(const std::string& path, const PointSet& set)
{
  if (extension(path) != ".ply") {
    detail::writeTable(path, detail::pointsToTable(set));
    return;
  }
  validatePointSet(set);
  detail::writePly(path, set.size(),
                   [&](Index begin, Index end) { return detail::pointsToTable(pointsBetween(set, begin, end)); });
}
} // namespace fresco
