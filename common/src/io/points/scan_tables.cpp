// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/scan_reader.h"
#include <algorithm>
#include <limits>
namespace fresco::io {
namespace {
/// Whole numbers of a column.
std::vector<Index> wholeNumbers(const PointTable& table, const char* name)
{
  std::vector<Index> numbers;
  const Column* column = table.find(name);
  if (!column || column->count != 1 || column->type == Scalar::float32 || column->type == Scalar::float64)
    return numbers;
  numbers.resize(table.rows);
  forEachValue(table, *column, 0, [&](Index row, auto value) { numbers[row] = value; });
  return numbers;
}

void blankCell(PointTable& table, Index row)
{
  for (const Column& column : table.columns)
    if (column.type == Scalar::float32 || column.type == Scalar::float64)
      storeValue(column.type, std::numeric_limits<double>::quiet_NaN(), table.cell(row, column));
}
} // namespace

void tellDamage(const std::vector<std::string>& errors, bool others)
{
  if (!others && !errors.empty())
    throw std::runtime_error(errors[0]);
  for (const std::string& error : errors)
    remark("could not be read: " + error);
}

void organise(PointTable& table)
{
  const std::vector<Index> rows = wholeNumbers(table, row_column), columns = wholeNumbers(table, column_column);
  if (rows.empty() || columns.empty()) // no such columns, or no points
    return;
  const auto [top, bottom] = std::minmax_element(rows.begin(), rows.end());
  const auto [left, right] = std::minmax_element(columns.begin(), columns.end());
  constexpr Index most_per_point = 4; // a scan of the sky's half has some 2
  const double places = (double(*bottom) - double(*top) + 1) * (double(*right) - double(*left) + 1);
  if (!(places <= double(most_per_point) * double(table.rows)))
    return;
  const Index width = *right - *left + 1, height = *bottom - *top + 1;
  std::vector<Index> source(width * height, -1);
  for (Index i = 0; i < table.rows; ++i) {
    Index& place = source[(rows[i] - *top) * width + columns[i] - *left];
    if (place >= 0)
      return; // several returns of one beam
    place = i;
  }
  PointTable grid;
  grid.sensor = table.sensor;
  addColumns(table, grid, [](const Column& c) { return c.name != row_column && c.name != column_column; });
  grid.allocate(width * height);
  std::tie(grid.width, grid.height) = std::pair(width, height);
  for (Index place = 0; place < grid.rows; ++place)
    if (source[place] < 0)
      blankCell(grid, place);
    else
      for (const Column& column : grid.columns)
        std::memcpy(grid.cell(place, column), table.cell(source[place], *table.find(column.name)), column.bytes());
  table = std::move(grid);
}

PointTable readScanTable(ScanReader& reader, Index scan)
{
  const ScanInfo& info = reader.scans()[scan];
  PointTable table = reader.open(scan);
  table.allocate(info.points);
  Index done = 0;
  while (const Index more = done < table.rows ? reader.read(table, done, table.rows) : 0)
    done += more;
  table.allocate(done);
  if (info.sensor)
    table.sensor = SensorPose{*info.sensor, Eigen::Quaternionf::Identity()};
  organise(table);
  narrowCoordinates(table);
  return table;
}

namespace {
/// What the layouts of all scans share; other types than the first one's become float64.
PointTable sharedLayout(const std::vector<PointTable>& layouts)
{
  PointTable shared;
  for (const Column& column : layouts[0].columns) {
    if (layouts.size() > 1 && (column.name == row_column || column.name == column_column))
      continue; // places in different scans
    Scalar type = column.type;
    bool everywhere = true;
    for (const PointTable& layout : layouts) {
      const Column* other = layout.find(column.name);
      everywhere = everywhere && other && other->count == column.count;
      if (other && other->type != type)
        type = Scalar::float64;
    }
    const bool coordinate = std::count(xyz_names, xyz_names + 3, column.name) > 0;
    if (everywhere && (type == column.type || column.count == 1))
      shared.addColumn(column.name, coordinate ? Scalar::float64 : type, column.count);
    else
      remark(concat("field ", column.name, " is not in all scans: left out"));
  }
  return shared;
}

/// Vectors of rows `begin` .. `end` - 1 become moved(vector).
template <typename Move>
void moveRows(PointTable& table, NameTriple names, Index begin, Index end, const Move& moved)
{
  const auto columns = findTriple(table, names);
  for (Index row = begin; columns && row < end; ++row) {
    Eigen::Vector3d v;
    for (int axis = 0; axis < 3; ++axis)
      v[axis] = valueAt(table, row, (*columns)[axis]);
    v = moved(v);
    for (int axis = 0; axis < 3; ++axis)
      storeValue((*columns)[axis].type, v[axis], table.cell(row, (*columns)[axis]));
  }
}

std::string nameOf(Index scan) { return concat("scan ", scan + 1); }

/// One scan into the rows of `merged` from `begin` on. @return the row behind its last
Index appendScan(ScanReader& reader, Index scan, PointTable& merged, Index begin)
{
  const ScanInfo& info = reader.scans()[scan];
  PointTable window = reader.open(scan);
  window.allocate(std::min(rows_per_window, info.points));
  while (begin < merged.rows) {
    const Index count = reader.read(window, 0, std::min(window.rows, merged.rows - begin));
    if (count == 0)
      break;
    const Index capacity = std::exchange(window.rows, count);
    copyRows(window, merged, begin);
    window.rows = capacity;
    const Index end = begin + count;
    const Eigen::Isometry3d& T = info.T_file_scan;
    moveRows(merged, xyz_names, begin, end, [&](const Eigen::Vector3d& p) -> Eigen::Vector3d { return T * p; });
    moveRows(merged, normal_names, begin, end,
             [&](const Eigen::Vector3d& n) -> Eigen::Vector3d { return T.linear() * n; });
    if (info.sensor)
      moveRows(merged, viewpoint_names, begin, end,
               [&](const Eigen::Vector3d&) -> Eigen::Vector3d { return T * *info.sensor; });
    begin = end;
  }
  return begin;
}
} // namespace

PointTable readMergedTable(ScanReader& reader)
{
  const std::vector<ScanInfo>& scans = reader.scans();
  std::vector<Index> used;
  std::vector<PointTable> layouts;
  Index rows = 0;
  std::vector<std::string> errors;
  for (Index i = 0; i < Index(scans.size()); ++i)
    if (scans[i].points > 0)
      attempt(nameOf(i), errors, [&] {
        layouts.push_back(reader.open(i));
        used.push_back(i);
        rows += scans[i].points;
      });
  tellDamage(errors, !used.empty());
  errors.clear();
  expect(!used.empty(), "no points");
  PointTable merged = sharedLayout(layouts);
  const bool sensors = std::all_of(used.begin(), used.end(), [&](Index i) { return scans[i].sensor.has_value(); });
  if (sensors && used.size() > 1)
    for (const char* name : viewpoint_names)
      if (!merged.find(name))
        merged.addColumn(name, Scalar::float64);
  merged.allocate(rows);
  Index done = 0;
  for (const Index scan : used)
    attempt(nameOf(scan), errors, [&] { done = appendScan(reader, scan, merged, done); });
  tellDamage(errors, done > 0);
  expect(done != 0, "no points");
  merged.allocate(done);
  if (sensors && used.size() == 1) {
    const ScanInfo& only = scans[used[0]];
    merged.sensor =
        SensorPose{only.T_file_scan * *only.sensor, Eigen::Quaterniond(only.T_file_scan.linear()).cast<float>()};
  }
  if (used.size() == 1)
    organise(merged);
  narrowCoordinates(merged);
  return merged;
}
} // namespace fresco::io
