// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/scan_reader.h"
#include <algorithm>
#include <fresco/core/require.h>
#include <limits>
#include <stdexcept>
namespace fresco::io {
namespace {
template <typename T>
void storeAt(std::uint8_t* at, T value)
{
  std::memcpy(at, &value, sizeof(T));
}

double valueAt(const PointTable& table, Index row, const Column& column)
{
  return visitScalar(column.type,
                     [&](auto zero) { return double(loadScalar<decltype(zero)>(table.cell(row, column))); });
}

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
    if (column.type == Scalar::float32)
      storeAt(table.cell(row, column), std::numeric_limits<float>::quiet_NaN());
    else if (column.type == Scalar::float64)
      storeAt(table.cell(row, column), std::numeric_limits<double>::quiet_NaN());
}
} // namespace

void ScanReader::settle(const std::vector<std::string>& errors) const
{
  const bool any = std::any_of(scans_.begin(), scans_.end(), [](const ScanInfo& info) { return info.points > 0; });
  if (!any && !errors.empty())
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
  std::vector<Column> kept;
  for (const Column& column : table.columns)
    if (column.name != row_column && column.name != column_column) {
      kept.push_back(column);
      grid.addColumn(column.name, column.type, column.count);
    }
  grid.allocate(width * height);
  std::tie(grid.width, grid.height) = std::pair(width, height);
  for (Index place = 0; place < grid.rows; ++place)
    if (source[place] < 0)
      blankCell(grid, place);
    else
      for (std::size_t c = 0; c < kept.size(); ++c)
        std::memcpy(grid.cell(place, grid.columns[c]), table.cell(source[place], kept[c]), kept[c].bytes());
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
  table.rows = done;
  table.data.resize(done * table.stride);
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

void copyValues(const PointTable& from, PointTable& to, Index begin)
{
  for (const Column& column : to.columns) {
    const Column* source = from.find(column.name);
    if (!source)
      continue;
    for (Index i = 0; i < from.rows; ++i)
      if (source->type == column.type)
        std::memcpy(to.cell(begin + i, column), from.cell(i, *source), column.bytes());
      else
        storeAt(to.cell(begin + i, column), valueAt(from, i, *source));
  }
}

/// Points and normals of rows `begin` .. `end` - 1 to the frame of the file.
void moveRows(PointTable& table, Index begin, Index end, const Eigen::Isometry3d& T)
{
  const auto xyz = findTriple(table, xyz_names), normal = findTriple(table, normal_names);
  const bool turn = normal && std::all_of(normal->begin(), normal->end(),
                                          [](const Column& column) { return column.type == Scalar::float32; });
  const Eigen::Matrix3d R = T.linear();
  for (Index row = begin; row < end; ++row) {
    Eigen::Vector3d p, n;
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = loadScalar<double>(table.cell(row, (*xyz)[axis]));
    const Eigen::Vector3d moved = T * p;
    for (int axis = 0; axis < 3; ++axis)
      storeAt(table.cell(row, (*xyz)[axis]), moved[axis]);
    if (!turn)
      continue;
    for (int axis = 0; axis < 3; ++axis)
      n[axis] = loadScalar<float>(table.cell(row, (*normal)[axis]));
    const Eigen::Vector3f turned = (R * n).cast<float>();
    for (int axis = 0; axis < 3; ++axis)
      storeAt(table.cell(row, (*normal)[axis]), turned[axis]);
  }
}

void storeViewpoints(PointTable& table, Index begin, Index end, const Eigen::Vector3d& viewpoint)
{
  const auto columns = findTriple(table, viewpoint_names);
  for (Index row = begin; columns && row < end; ++row)
    for (int axis = 0; axis < 3; ++axis)
      storeAt(table.cell(row, (*columns)[axis]), viewpoint[axis]);
}

/// Scans of which one that cannot be read does not cost the others.
class SoundParts {
public:
  template <typename Read>
  void attempt(Index scan, const Read& read)
  {
    try {
      read();
    } catch (const std::runtime_error& error) {
      errors_.push_back(concat("scan ", scan + 1, ": ", error.what()));
    }
  }
  /// Remarks on the others. @throws std::runtime_error unless there is any
  void requireAny(bool any)
  {
    if (!any)
      throw std::runtime_error(errors_.empty() ? "no points" : errors_[0]);
    for (const std::string& error : std::exchange(errors_, {}))
      remark("could not be read: " + error);
  }

private:
  std::vector<std::string> errors_;
};

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
    copyValues(window, merged, begin);
    window.rows = capacity;
    moveRows(merged, begin, begin + count, info.T_file_scan);
    if (info.sensor)
      storeViewpoints(merged, begin, begin + count, info.T_file_scan * *info.sensor);
    begin += count;
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
  SoundParts parts;
  for (Index i = 0; i < Index(scans.size()); ++i)
    if (scans[i].points > 0)
      parts.attempt(i, [&] {
        layouts.push_back(reader.open(i));
        used.push_back(i);
        rows += scans[i].points;
      });
  parts.requireAny(!used.empty());
  PointTable merged = sharedLayout(layouts);
  const bool sensors = std::all_of(used.begin(), used.end(), [&](Index i) { return scans[i].sensor.has_value(); });
  if (sensors && used.size() > 1)
    for (const char* name : viewpoint_names)
      if (!merged.find(name))
        merged.addColumn(name, Scalar::float64);
  merged.allocate(rows);
  Index done = 0;
  for (const Index scan : used)
    parts.attempt(scan, [&] { done = appendScan(reader, scan, merged, done); });
  parts.requireAny(done > 0);
  merged.rows = done;
  merged.data.resize(done * merged.stride);
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
