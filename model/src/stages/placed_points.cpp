// SPDX-License-Identifier: BSD-3-Clause
#include "stages/placed_points.h"
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/point_files.h>
#include <fresco/io/point_io.h>
#include <iomanip>
#include <sstream>
#include <thread>
namespace fresco::model {
void PlacedPoints::clear() const
{
  std::error_code error;
  std::filesystem::remove_all(folder_, error);
  if (error)
    throw std::runtime_error(folder_ + ": " + error.message());
  makeFolder(folder_);
}

void PlacedPoints::write(Index scan, const PointSet& points) const
{
  std::ostringstream name; // as long for all, so that the order of names is that of the scans
  name << folder_ << "/scan_" << std::setw(6) << std::setfill('0') << scan << ".pcd";
  writePoints(name.str(), points);
}

void PlacedPoints::await(Index count) const
{
  constexpr std::chrono::milliseconds pause(300), patience(90000); // NFS keeps what it knows of a folder for 60 s
  const auto is_file = [](const auto& entry) { return entry.path().filename().string()[0] != '.'; };
  for (std::chrono::milliseconds waited(0);; waited += pause) {
    const std::filesystem::directory_iterator entries(folder_);
    if (std::count_if(entries, {}, is_file) >= count)
      return;
    if (waited > patience)
      throw std::runtime_error(folder_ + ": what other ranks wrote is not there; all must see the same folder");
    std::this_thread::sleep_for(pause);
  }
}

std::vector<std::string> PlacedPoints::files() const { return pointFilesIn({folder_}); }

std::unique_ptr<PointStream> PlacedPoints::stream() const
{
  std::vector<ScanPath> paths;
  for (const std::string& file : files())
    paths.push_back({file});
  return openPointFiles(paths);
}

void PlacedPoints::forEach(const std::function<void(const PointSet&)>& receive) const
{
  for (const std::string& file : files())
    receive(readPoints(file));
}

PointSet PlacedPoints::sample(Index most) const
{
  const Index step = (countPoints(*stream()) + most - 1) / most;
  PointSet all;
  Index before = 0;
  forEach([&](const PointSet& points) {
    std::vector<Index> kept;
    for (Index i = (step - before % step) % step; i < points.size(); i += step)
      kept.push_back(i);
    before += points.size();
    appendPoints(all, step == 1 ? points : selectPoints(points, kept));
  });
  return all;
}

Index countPoints(const PointStream& points)
{
  Index count = 0;
  points.read([&](const PointSet& window) { count += window.size(); });
  return count;
}
} // namespace fresco::model
