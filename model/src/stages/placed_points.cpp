// SPDX-License-Identifier: BSD-3-Clause
#include "stages/placed_points.h"
#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fresco/core/morton.h>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/ply_rows.h>
#include <fresco/io/point_files.h>
#include <fresco/io/point_io.h>
#include <iomanip>
#include <sstream>
#include <thread>
#include <unordered_map>
namespace fresco::model {
namespace {
Eigen::Vector3d placeOf(const PointSet& points, Index i) { return points.origin + points.points.col(i).cast<double>(); }

/// Shares out a number of points among the cells of a grid: each gives all that it has, up to the same number. So places
/// that few points hit keep them, and those close to a scanner give the most.
class EvenShares {
public:
  /// @param box  of all points. @param most points in all
  EvenShares(const Eigen::AlignedBox3d& box, Index most) : corner_(box.min()), most_(std::max<Index>(most, 1))
  {
    constexpr double points_a_cell = 24; // of those kept, if the surface covers one side of the box
    const double side = std::max(box.sizes().maxCoeff(), 1e-12);
    last_ = std::clamp(std::sqrt(double(most_) / points_a_cell), 1.0, double(1 << 20)) - 1;
    cells_a_unit_ = (last_ + 1) / side;
  }

  void count(const PointSet& points)
  {
    for (Index i = 0; i < points.size(); ++i)
      ++cells_[cellOf(points, i)].points;
  }

  /// Once all are counted.
  void limit()
  {
    while (Index(cells_.size()) > most_)
      coarsen();
    Index too_many = most_ + 1;
    for (share_ = 0; too_many - share_ > 1;) {
      const Index middle = (share_ + too_many) / 2;
      Index kept = 0;
      for (const auto& [code, cell] : cells_)
        kept += std::min(cell.points, middle);
      (kept <= most_ ? share_ : too_many) = middle;
    }
  }

  /// Those to keep, spread over the order in which each cell has its points.
  std::vector<Index> take(const PointSet& points)
  {
    std::vector<Index> kept;
    for (Index i = 0; i < points.size(); ++i) {
      Cell& cell = cells_[cellOf(points, i)];
      const Index share = std::min(share_, cell.points), before = cell.seen++;
      if ((before + 1) * share / cell.points > before * share / cell.points)
        kept.push_back(i);
    }
    return kept;
  }

private:
  struct Cell {
    Index points = 0, seen = 0;
  };

  std::uint64_t cellOf(const PointSet& points, Index i) const
  {
    const Eigen::Vector3d at = (placeOf(points, i) - corner_) * cells_a_unit_;
    const auto on = [&](int axis) { return static_cast<std::uint32_t>(std::min(std::max(0.0, at[axis]), last_)); };
    return mortonCode(on(0), on(1), on(2)) >> shift_;
  }

  void coarsen()
  {
    std::unordered_map<std::uint64_t, Cell> coarse;
    for (const auto& [code, cell] : cells_)
      coarse[code >> 3].points += cell.points;
    cells_.swap(coarse);
    shift_ += 3;
  }

  Eigen::Vector3d corner_;
  Index most_, share_ = 0;
  double cells_a_unit_ = 1, last_ = 0;
  int shift_ = 0;
  std::unordered_map<std::uint64_t, Cell> cells_; ///< by Morton code
};
} // namespace

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
  Index count = 0;
  Eigen::AlignedBox3d box;
  forEach([&](const PointSet& points) {
    count += points.size();
    for (Index i = 0; i < points.size(); ++i)
      box.extend(placeOf(points, i));
  });
  EvenShares shares(box, most);
  if (count > most) {
    forEach([&](const PointSet& points) { shares.count(points); });
    shares.limit();
  }
  PointSet all;
  forEach([&](const PointSet& points) {
    appendPoints(all, count > most ? selectPoints(points, shares.take(points)) : points);
  });
  return all;
}

void PlacedPoints::writePly(const std::string& path) const
{
  const std::unique_ptr<PointStream> all = stream();
  const Index count = countPoints(*all);
  OutputFile file(path);
  bool begun = false;
  all->read([&](const PointSet& window) {
    const core::PointTable rows = io::plyRows(core::pointsToTable(window));
    if (!begun)
      file.write(io::plyHeader(rows, count, 0));
    begun = true;
    file.write(rows.rowsBegin(), std::size_t(rows.rows) * rows.stride);
  });
  file.commit();
}

Index countPoints(const PointStream& points)
{
  Index count = 0;
  points.read([&](const PointSet& window) { count += window.size(); });
  return count;
}
} // namespace fresco::model
