// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/ply.h"
#include "io/points/parse_file.h"
#include <fresco/io/point_io.h>
#include <numeric>
namespace fresco {
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
