// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/format_table.h"
#include "io/points/parse_file.h"
#include "io/points/scan_reader.h"
#include <algorithm>
#include <fresco/io/point_io.h>
#include <fresco/io/scan_file.h>
namespace fresco {
namespace {
std::unique_ptr<io::ScanReader> openScans(const ScanPath& path)
{
  const io::Format& format = io::formatToRead(path.file, FileKind::points);
  expect(format.open_scans, path.file, ": holds one cloud, there is no scan to choose");
  return io::namingFile(path.file, [&] { return format.open_scans(path); });
}

void checkScan(const io::ScanReader& reader, Index scan)
{
  const Index count = reader.scans().size();
  expect(scan >= 0 && scan < count, "there is no scan ", scan + 1, ", the file has ", count);
}
} // namespace

std::string ScanPath::name() const { return scan < 0 ? file : concat(file, " scan ", scan + 1); }

bool holdsScans(const std::string& path)
{
  return isReadable(path, FileKind::points) && io::formatToRead(path, FileKind::points).open_scans != nullptr;
}

std::vector<ScanInfo> readScanInfos(const std::string& path) { return readScanInfos(ScanPath{path}); }

std::vector<ScanInfo> readScanInfos(const ScanPath& path)
{
  const auto reader = openScans(path);
  expect(!reader->scans().empty(), path.file, ": no scan in it");
  return reader->scans();
}

std::vector<ScanPath> scansOf(const std::vector<std::string>& files, bool keep_broken)
{
  std::vector<ScanPath> scans;
  std::vector<std::string> without;
  for (const std::string& file : files) {
    std::vector<ScanInfo> infos(1);
    std::shared_ptr<const io::ScanIndex> index;
    try {
      if (holdsScans(file)) {
        const auto reader = openScans({file});
        infos = reader->scans();
        index = reader->index();
      }
    } catch (const std::runtime_error&) {
      if (!keep_broken)
        throw;
    }
    if (infos.empty())
      without.push_back(file);
    if (infos.size() == 1 && !infos[0].has_pose)
      scans.push_back({file, -1});
    else
      for (Index i = 0; i < Index(infos.size()); ++i)
        scans.push_back({file, i, index});
  }
  if (scans.empty() && !without.empty())
    readScanInfos(without[0]); // which throws
  for (const std::string& file : without)
    io::namingFile(file, [] { io::remark("no scan in it: left out"); });
  return scans;
}

std::vector<Pose> posesOf(const std::vector<ScanPath>& scans)
{
  std::vector<Pose> poses;
  std::string known;
  std::vector<ScanInfo> infos;
  for (const ScanPath& path : scans) {
    if (path.scan >= 0 && path.file != known) {
      infos = readScanInfos(path);
      known = path.file;
    }
    const bool placed = path.scan >= 0 && path.scan < Index(infos.size()) && infos[path.scan].has_pose;
    poses.push_back(placed ? Pose(infos[path.scan].T_file_scan.matrix()) : Pose());
  }
  return poses;
}

namespace io {
PointTable readTable(const ScanPath& path)
{
  if (path.scan < 0)
    return readTable(path.file);
  const auto reader = openScans(path);
  return namingFile(path.file, [&] {
    checkScan(*reader, path.scan);
    return readScanTable(*reader, path.scan);
  });
}
} // namespace io

PointSet readPoints(const ScanPath& path)
{
  if (path.scan < 0)
    return readPoints(path.file);
  return io::namingFile(path.file, [&] { return io::tableToPoints(io::readTable(path)); });
}

void streamPoints(const ScanPath& path, Index window, const std::function<bool(const PointSet&)>& receive)
{
  require(window >= 1, "points: a window of ", window);
  if (!holdsScans(path.file)) {
    receive(readPoints(path));
    return;
  }
  const auto reader = openScans(path);
  const Index scan = std::max<Index>(path.scan, 0);
  io::PointTable table = io::namingFile(path.file, [&] {
    checkScan(*reader, scan);
    return reader->open(scan);
  });
  const ScanInfo& info = reader->scans()[scan];
  if (info.sensor)
    table.sensor = io::SensorPose{*info.sensor, Eigen::Quaternionf::Identity()};
  if (info.points == 0)
    return;
  const Index capacity = std::min(window, info.points);
  table.allocate(capacity);
  PointSet points;
  do {
    table.rows = 0;
    points = io::namingFile(path.file, [&] {
      while (const Index more = table.rows < capacity ? reader->read(table, table.rows, capacity) : 0)
        table.rows += more;
      return io::tableToPoints(table);
    });
  } while (points.size() > 0 && receive(points));
}
} // namespace fresco
