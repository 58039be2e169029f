// SPDX-License-Identifier: BSD-3-Clause
#include "plan/regions.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/require.h>
#include <fresco/core/union_find.h>
#include <map>
#include <opencv2/imgproc.hpp>
#include <unordered_set>
namespace fresco::plan {
namespace {
constexpr double least_radius = 0.35; // metres, of the largest circle in a room
constexpr double least_area = 1;      // square metres

bool isInBand(const Eigen::Vector3f& p, const Storey& s) { return p.z() >= s.wall_low && p.z() <= s.wall_high; }

/// The finest cell that on average has some samples where it has any.
double cellFromDensity(const RegionInput& input)
{
  constexpr double enough = 4;
  for (const double cell : {0.02, 0.03, 0.04, 0.06, 0.08}) {
    std::unordered_set<std::uint64_t> cells;
    std::size_t count = 0;
    for (const Eigen::Vector3f& p : input.upright)
      if (isInBand(p, input.storey)) {
        const auto name = [&](float x) { return static_cast<std::uint32_t>(std::lround(std::floor(x / cell))); };
        cells.insert(std::uint64_t(name(p.x())) << 32 | name(p.y()));
        ++count;
      }
    if (count >= enough * cells.size())
      return cell;
  }
  return 0.12;
}

Grid makeGrid(const RegionInput& input)
{
  constexpr double margin = 0.5, most_cells = 1e8;
  Eigen::Array2d low(0, 0), high(0, 0);
  if (!input.upright.empty())
    low = high = input.upright.front().head<2>().cast<double>().array();
  for (const Eigen::Vector3f& p : input.upright) {
    low = low.min(p.head<2>().cast<double>().array());
    high = high.max(p.head<2>().cast<double>().array());
  }
  Grid grid;
  grid.cell = input.cell > 0 ? input.cell : cellFromDensity(input);
  const Eigen::Array2d size = high - low + 2 * margin;
  require(size.prod() / (grid.cell * grid.cell) < most_cells, "plan: the model has ", size.x(), " x ", size.y(),
          " m, too much for cells of ", grid.cell, " m; is its unit the metre?");
  grid.low = low - margin;
  grid.width = static_cast<int>(size.x() / grid.cell) + 1;
  grid.height = static_cast<int>(size.y() / grid.cell) + 1;
  return grid;
}

cv::Mat boxOf(double metres, double cell)
{
  const int side = 2 * static_cast<int>(metres / 2 / cell) + 1;
  return cv::getStructuringElement(cv::MORPH_RECT, {side, side});
}

cv::Mat occupied(const Grid& grid, const RegionInput& input, double low, double high)
{
  cv::Mat cells(grid.height, grid.width, CV_8U, cv::Scalar(0));
  for (const Eigen::Vector3f& p : input.upright)
    if (p.z() >= low && p.z() <= high)
      if (const Index at = grid.at(p.x(), p.y()); at >= 0)
        cells.data[at] = 255;
  return cells;
}

/// Cells with samples at every height from the floor up to the walls' own: nothing that hangs above furniture or people.
cv::Mat standing(const Grid& grid, const RegionInput& input, double low)
{
  constexpr int slices = 8;
  cv::Mat filled(grid.height, grid.width, CV_8U, cv::Scalar(0));
  for (const Eigen::Vector3f& p : input.upright)
    if (const double slice = slices * (p.z() - low) / (input.storey.wall_low - low); slice >= 0 && slice < slices)
      if (const Index at = grid.at(p.x(), p.y()); at >= 0)
        filled.data[at] = static_cast<std::uint8_t>(filled.data[at] | 1 << static_cast<int>(slice));
  return filled == (1 << slices) - 1;
}

/// Where floor or ceiling were seen, without the holes under and over furniture.
cv::Mat covered(const Grid& grid, const RegionInput& input)
{
  constexpr double near = 0.25, reach = 0.06, hole = 0.5; // metres; slabs between storeys are thicker than the first
  cv::Mat cells(grid.height, grid.width, CV_8U, cv::Scalar(0));
  for (std::size_t i = 0; i < input.level.points.size(); ++i) {
    const Eigen::Vector3f& p = input.level.points[i];
    const bool floor = input.level.facing[i] >= 0 && std::abs(p.z() - input.storey.floor) < near;
    const bool ceiling = input.level.facing[i] <= 0 && std::abs(p.z() - input.storey.ceiling) < near;
    if (floor || (ceiling && input.storey.has_ceiling))
      if (const Index at = grid.at(p.x(), p.y()); at >= 0)
        cells.data[at] = 255;
  }
  cv::morphologyEx(cells, cells, cv::MORPH_CLOSE, boxOf(hole, grid.cell), {-1, -1}, 1, cv::BORDER_CONSTANT);
  cv::dilate(cells, cells, boxOf(2 * reach, grid.cell));
  return cells;
}

/// Flooding from the deepest cells on. Two basins that meet stay apart where the passage between them is narrower than
/// a door and much narrower than both. @return the basin of each cell, named by its deepest one; -1 = not free
std::vector<Index> flood(const cv::Mat& depth, float door_radius)
{
  constexpr float shallow = 0.75f; // of the smaller basin's radius: no passage, a bulge
  const Index n = static_cast<Index>(depth.total());
  const float* deep = depth.ptr<float>();
  std::vector<Index> order;
  for (Index i = 0; i < n; ++i)
    if (deep[i] > 0)
      order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return deep[a] > deep[b]; });
  std::vector<Index> basin(n, -1); // index into peaks
  std::vector<Index> peaks;
  UnionFind sets(static_cast<Index>(order.size()));     // roots are the earliest: the deepest
  const Index w = depth.cols, steps[] = {-1, 1, -w, w}; // not across corners: walls are thin
  for (const Index cell : order) {
    Index mine = -1;
    for (const Index step : steps) { // the margin of the grid is never free
      const Index next = basin[cell + step] < 0 ? -1 : sets.root(basin[cell + step]);
      if (next < 0 || next == mine)
        continue;
      if (mine < 0) {
        mine = next;
        continue;
      }
      const Index smaller = std::max(mine, next);
      if (deep[cell] >= std::min(door_radius, shallow * deep[peaks[smaller]]))
        sets.join(mine, next);
      mine = std::min(mine, next);
    }
    if (mine < 0) {
      mine = static_cast<Index>(peaks.size());
      peaks.push_back(cell);
    }
    basin[cell] = mine;
  }
  for (Index& name : basin)
    name = name < 0 ? -1 : peaks[sets.root(name)];
  return basin;
}

/// Basins that are rooms, the largest first.
std::vector<Index> roomsAmong(const std::vector<Index>& basins, const cv::Mat& depth, double cell)
{
  std::vector<Index> sizes(basins.size(), 0), rooms;
  for (const Index basin : basins)
    if (basin >= 0)
      ++sizes[basin];
  for (Index i = 0; i < static_cast<Index>(sizes.size()); ++i)
    if (sizes[i] * cell * cell > least_area && depth.ptr<float>()[i] * cell > least_radius)
      rooms.push_back(i);
  std::stable_sort(rooms.begin(), rooms.end(), [&](Index a, Index b) { return sizes[a] > sizes[b]; });
  return rooms;
}

/// Takes away what hangs from the ceiling and touches no wall: lamps.
void dropHanging(cv::Mat& walls, const cv::Mat& standing, double cell)
{
  cv::Mat near, numbers;
  cv::dilate(walls, near, boxOf(3 * cell, cell));
  std::vector<bool> stands(static_cast<std::size_t>(cv::connectedComponents(near, numbers)), false);
  for (int i = 0; i < static_cast<int>(walls.total()); ++i)
    if (standing.data[i] > 0)
      stands[numbers.ptr<int>()[i]] = true;
  for (int i = 0; i < static_cast<int>(walls.total()); ++i)
    if (!stands[numbers.ptr<int>()[i]])
      walls.data[i] = 0;
}

/// What ends rooms below the ceiling although nothing stands beneath: cells where two rooms are nearest to each other
/// across a passage wider than doors are. @param rooms per cell, 0 = none. @param furnished what stands up to the cut
cv::Mat beams(const cv::Mat& rooms, const cv::Mat& furnished, const Grid& grid, double door)
{
  constexpr double thickest = 0.6, jambs = 0.2; // metres
  cv::Mat distance, nearest, none = rooms == 0, wide, found(rooms.size(), CV_8U, cv::Scalar(0));
  cv::distanceTransform(none, distance, nearest, cv::DIST_L2, 5, cv::DIST_LABEL_PIXEL);
  std::vector<int> room_of(1 + static_cast<std::size_t>(cv::countNonZero(none == 0)), 0);
  for (int i = 0; i < static_cast<int>(rooms.total()); ++i)
    if (rooms.ptr<int>()[i] > 0)
      room_of[nearest.ptr<int>()[i]] = rooms.ptr<int>()[i];
  cv::dilate(furnished, wide, boxOf(2 * jambs, grid.cell));
  std::map<std::pair<int, int>, std::vector<int>> passages; // cells
  for (int i = 0; i + grid.width < static_cast<int>(rooms.total()); ++i)
    for (const int next : {i + 1, i + grid.width}) {
      const int a = room_of[nearest.ptr<int>()[i]], b = room_of[nearest.ptr<int>()[next]];
      if (a != b && a * b > 0 && wide.data[i] == 0 && distance.ptr<float>()[i] * grid.cell < thickest / 2)
        passages[std::minmax(a, b)].push_back(i);
    }
  for (const auto& [pair, cells] : passages)
    if (cells.size() * grid.cell + 2 * jambs > 1.5 * door)
      for (const int i : cells)
        found.data[i] = 255;
  cv::dilate(found, found, boxOf(2 * jambs + thickest, grid.cell));
  return found;
}

Polyline toMetres(const std::vector<cv::Point>& contour, const Grid& grid, bool counter_clockwise)
{
  Polyline line(2, contour.size());
  double area = 0;
  for (std::size_t k = 0; k < contour.size(); ++k) {
    const cv::Point& next = contour[(k + 1) % contour.size()];
    area += double(contour[k].x) * next.y - double(next.x) * contour[k].y;
    line.col(k) = grid.center(contour[k].x, contour[k].y);
  }
  if ((area > 0) != counter_clockwise)
    line = line.rowwise().reverse().eval();
  return line;
}

/// Whether something stands at a contour at the height of the cut, too: it is no lamp.
bool standsBelow(const std::vector<cv::Point>& contour, const cv::Mat& below)
{
  const int solid = static_cast<int>(
      std::count_if(contour.begin(), contour.end(), [&](const cv::Point& p) { return below.at<std::uint8_t>(p) > 0; }));
  return 2 * solid > static_cast<int>(contour.size());
}

Region regionOf(cv::Mat mask, const Grid& grid, const cv::Mat& below)
{
  constexpr double slit = 0.15; // metres: what was covered beyond a wall that has a gap
  cv::morphologyEx(mask, mask, cv::MORPH_OPEN, boxOf(slit, grid.cell));
  constexpr double least_column = 0.04; // square metres
  std::vector<std::vector<cv::Point>> contours;
  std::vector<cv::Vec4i> tree;
  cv::findContours(mask, contours, tree, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE);
  Region region;
  double most = -1;
  for (std::size_t k = 0; k < contours.size(); ++k) {
    const double area = cv::contourArea(contours[k]) * grid.cell * grid.cell;
    if (tree[k][3] < 0 && area > most) {
      most = area;
      region.outline = toMetres(contours[k], grid, true);
    } else if (tree[k][3] >= 0 && area > least_column && standsBelow(contours[k], below)) {
      region.columns.push_back(toMetres(contours[k], grid, false));
    }
  }
  return region;
}

/// Rooms of a plan in which `free` is where one can be.
class RoomFinder {
public:
  RoomFinder(const Grid& grid, double door) : grid_(grid), door_(door) {}

  void find(const cv::Mat& free)
  {
    cv::Mat inner = free.clone();
    cv::rectangle(inner, {0, 0}, {grid_.width - 1, grid_.height - 1}, 0); // a border that flooding never leaves
    cv::distanceTransform(inner, depth, cv::DIST_L2, cv::DIST_MASK_PRECISE);
    const std::vector<Index> basins = flood(depth, static_cast<float>(door_ / 2 / grid_.cell));
    peaks = roomsAmong(basins, depth, grid_.cell);
    std::map<Index, int> numbers;
    for (std::size_t r = 0; r < peaks.size(); ++r)
      numbers[peaks[r]] = static_cast<int>(r) + 1;
    rooms = cv::Mat(grid_.height, grid_.width, CV_32S, cv::Scalar(0));
    for (std::size_t i = 0; i < basins.size(); ++i)
      if (const auto number = numbers.find(basins[i]); number != numbers.end())
        rooms.ptr<int>()[i] = number->second;
  }

  /// The cell nearest to the middle of a room among those that are nearly as deep as its deepest.
  Eigen::Vector2d labelPlace(std::size_t room) const
  {
    const float least = 0.9f * depth.ptr<float>()[peaks[room]];
    const cv::Moments moments = cv::moments(rooms == static_cast<int>(room) + 1, true);
    const Eigen::Vector2d middle = grid_.center(moments.m10 / moments.m00, moments.m01 / moments.m00);
    Eigen::Vector2d best = grid_.center(peaks[room] % grid_.width, peaks[room] / grid_.width);
    for (int i = 0; i < static_cast<int>(rooms.total()); ++i)
      if (rooms.ptr<int>()[i] == static_cast<int>(room) + 1 && depth.ptr<float>()[i] >= least)
        if (const Eigen::Vector2d at = grid_.center(i % grid_.width, i / grid_.width);
            (at - middle).norm() < (best - middle).norm())
          best = at;
    return best;
  }

  std::vector<Index> peaks; ///< deepest cell of each room
  cv::Mat depth;            ///< cells to the nearest wall
  cv::Mat rooms;            ///< per cell, from 1; 0 = none

private:
  const Grid& grid_;
  double door_;
};
} // namespace

Regions findRegions(const RegionInput& input)
{
  constexpr double skirting = 0.06, cut_band = 0.1; // metres
  const Storey& storey = input.storey;
  Regions found{makeGrid(input), {}, {}};
  const Grid& grid = found.grid;
  const cv::Mat seen = covered(grid, input);
  cv::Mat walls = occupied(grid, input, storey.wall_low, storey.wall_high);
  const cv::Mat furnished = occupied(grid, input, storey.floor + skirting, storey.height);
  RoomFinder finder(grid, input.door);
  if (storey.has_ceiling)
    dropHanging(walls, standing(grid, input, storey.floor + skirting), grid.cell);
  finder.find(seen & ~walls);
  if (storey.has_ceiling)
    if (const cv::Mat open = beams(finder.rooms, furnished, grid, input.door); cv::countNonZero(open) > 0) {
      walls.setTo(0, open & ~furnished);
      finder.find(seen & ~walls);
    }
  cv::Mat below = occupied(grid, input, storey.height - cut_band, storey.height + cut_band);
  cv::dilate(below, below, boxOf(5 * grid.cell, grid.cell));
  found.labels.resize(finder.rooms.total());
  for (std::size_t i = 0; i < found.labels.size(); ++i)
    found.labels[i] = finder.rooms.ptr<int>()[i] - 1;
  for (std::size_t r = 0; r < finder.peaks.size(); ++r) {
    found.regions.push_back(regionOf(finder.rooms == static_cast<int>(r) + 1, grid, below));
    found.regions.back().label = finder.labelPlace(r);
  }
  return found;
}
} // namespace fresco::plan
