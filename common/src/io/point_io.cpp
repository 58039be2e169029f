// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/ply.h"
#include "io/points/parse_file.h"
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
} // namespace

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
  io::writePly(
      path, set.size(), [&](Index begin, Index end) { return io::pointsToTable(pointsBetween(set, begin, end)); },
      Faces());
}
} // namespace fresco
