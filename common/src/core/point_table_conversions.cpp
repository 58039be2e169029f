// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <fresco/core/point_table.h>
#include <fresco/core/require.h>
#include <functional>
namespace fresco::core {
namespace {
constexpr const char* no_coordinates = "no coordinates x y z";

template <typename Body>
void forEachRow(const PointTable& table, const Body& body)
{
  parallelFor(table.rows, 0, body, rows_per_task);
}

bool areFloatsInARow(const std::array<Column, 3>& columns)
{
  for (std::size_t i = 0; i < 3; ++i)
    if (columns[i].type != Scalar::float32 || columns[i].offset != columns[0].offset + i * sizeof(float))
      return false;
  return true;
}

/// 3xN less `origin`, 3x0 unless all three columns are there.
Points tripleValues(const PointTable& table, NameTriple names, const Eigen::Vector3d& origin = Eigen::Vector3d::Zero())
{
  const auto columns = findTriple(table, names);
  Points values(3, columns ? table.rows : 0);
  if (columns && origin.isZero(0) && areFloatsInARow(*columns)) {
    forEachRow(table, [&](Index row) {
      std::memcpy(values.col(row).data(), table.cell(row, (*columns)[0]), 3 * sizeof(float));
    });
    return values;
  }
  for (int axis = 0; columns && axis < 3; ++axis)
    forEachValue(table, (*columns)[axis], 0,
                 [&](Index row, auto value) { values(axis, row) = static_cast<double>(value) - origin[axis]; });
  return values;
}

/// What to take off the coordinates so that float keeps them.
Eigen::Vector3d originOf(const PointTable& table)
{
  const auto xyz = findTriple(table, xyz_names);
  if (!xyz)
    throw std::runtime_error(no_coordinates);
  if (std::all_of(xyz->begin(), xyz->end(), [](const Column& column) { return column.type == Scalar::float32; }))
    return Eigen::Vector3d::Zero();
  const CoordinateBounds bounds = coordinateBounds(table, *xyz);
  return bounds.exceedsFloat() ? bounds.origin() : Eigen::Vector3d::Zero();
}

Colors readColors(const PointTable& table)
{
  Colors colors;
  if (const Column* column = packedColor(table)) {
    colors.resize(3, table.rows);
    forEachRow(table, [&](Index row) {
      const auto packed = loadScalar<std::uint32_t>(table.cell(row, *column));
      colors.col(row) << std::uint8_t(packed >> 16), std::uint8_t(packed >> 8), std::uint8_t(packed);
    });
  } else if (const auto rgb = findTriple(table, color_names)) {
    colors.resize(3, table.rows);
    const double full = fullColor(table, *rgb);
    for (int channel = 0; channel < 3; ++channel)
      forEachValue(table, (*rgb)[channel], 0, [&](Index row, auto value) {
        colors(channel, row) = sizeof(value) == 1 ? std::uint8_t(value) : colorByte(value, full);
      });
  }
  return colors;
}

Eigen::VectorXf valuesOf(const PointTable& table, const char* name)
{
  const Column* column = table.find(name);
  return column ? columnValues(table, *column) : Eigen::VectorXf();
}

/// Adds columns with what fills them; they are filled once all are there.
class TableWriter {
public:
  /// @param first row of the values that the table begins with
  explicit TableWriter(Index first = 0) : first_(first) {}

  /// @param value value(row), of the size that `type` has
  template <typename Value>
  void add(const std::string& name, Scalar type, const Value& value)
  {
    table_.addColumn(name, type);
    fills_.push_back([this, value, column = table_.columns.back()] {
      forEachRow(table_, [&](Index row) {
        const auto stored = value(first_ + row);
        std::memcpy(table_.cell(row, column), &stored, sizeof stored);
      });
    });
  }

  void addTriple(NameTriple names, const Points& values)
  {
    for (int axis = 0; axis < 3; ++axis)
      add(names[axis], Scalar::float32, [&values, axis](Index row) { return values(axis, row) + 0.f; }); // no -0
  }

  /// As float64 unless `origin` is zero.
  void addPositions(NameTriple names, const Points& values, const Eigen::Vector3d& origin)
  {
    if (origin.isZero(0))
      return addTriple(names, values);
    for (int axis = 0; axis < 3; ++axis)
      add(names[axis], Scalar::float64,
          [&values, axis, shift = origin[axis]](Index row) { return values(axis, row) + shift; });
  }

  void addValues(const std::string& name, const Eigen::VectorXf& values)
  {
    add(name, Scalar::float32, [&values](Index row) { return values[row]; });
  }

  void addColors(const Colors& colors)
  {
    add("rgb", Scalar::float32, [&colors](Index row) {
      return std::uint32_t{colors(0, row)} << 16 | std::uint32_t{colors(1, row)} << 8 | colors(2, row);
    });
  }

  PointTable take(Index rows)
  {
    table_.allocate(rows);
    for (const auto& fill : fills_)
      fill();
    return std::move(table_);
  }

private:
  const Index first_;
  PointTable table_;
  std::vector<std::function<void()>> fills_;
};
} // namespace

PointSet tableToPoints(const PointTable& table) { return tableToPoints(table, originOf(table)); }

PointSet tableToPoints(const PointTable& table, const Eigen::Vector3d& origin)
{
  if (!findTriple(table, xyz_names))
    throw std::runtime_error(no_coordinates);
  PointSet set;
  set.origin = origin;
  set.points = tripleValues(table, xyz_names, set.origin);
  set.normals = tripleValues(table, normal_names);
  set.colors = readColors(table);
  set.intensities = valuesOf(table, "intensity");
  set.confidences = valuesOf(table, "confidence");
  set.viewpoints = tripleValues(table, viewpoint_names, set.origin);
  if (set.viewpoints.cols() == 0 && table.sensor)
    set.viewpoints = (table.sensor->position - set.origin).cast<float>();
  return set;
}

PointTable pointsToTable(const PointSet& set)
{
  validatePointSet(set);
  TableWriter writer;
  writer.addPositions(xyz_names, set.points, set.origin);
  if (set.normals.cols() > 0)
    writer.addTriple(normal_names, set.normals);
  if (set.colors.cols() > 0)
    writer.addColors(set.colors);
  if (set.intensities.size() > 0)
    writer.addValues("intensity", set.intensities);
  if (set.confidences.size() > 0)
    writer.addValues("confidence", set.confidences);
  if (set.viewpoints.cols() > 1)
    writer.addPositions(viewpoint_names, set.viewpoints, set.origin);
  PointTable table = writer.take(set.size());
  if (set.viewpoints.cols() == 1)
    table.sensor = SensorPose{set.origin + set.viewpoints.col(0).cast<double>(), Eigen::Quaternionf::Identity()};
  return table;
}

TriangleMesh tableToMesh(const PointTable& table, Faces faces)
{
  TriangleMesh mesh;
  mesh.faces = std::move(faces);
  mesh.origin = originOf(table);
  mesh.vertices = tripleValues(table, xyz_names, mesh.origin);
  mesh.normals = tripleValues(table, normal_names);
  mesh.colors = readColors(table);
  const Column* packed = packedColor(table);
  for (const Column& column : table.columns) {
    const std::string& name = column.name;
    const auto is_in = [&](NameTriple names) { return std::count(names, names + 3, name) > 0; };
    const bool is_color = packed ? &column == packed : mesh.colors.cols() > 0 && is_in(color_names);
    if (is_color || is_in(xyz_names) || (mesh.normals.cols() > 0 && is_in(normal_names)))
      continue;
    for (std::size_t k = 0; k < column.count; ++k)
      mesh.fields[column.count == 1 ? name : concat(name, '_', k)] = columnValues(table, column, k);
  }
  return mesh;
}

PointTable meshToTable(const TriangleMesh& mesh)
{
  validateMesh(mesh);
  return verticesToTable(mesh, 0, mesh.vertexCount());
}

PointTable verticesToTable(const TriangleMesh& mesh, Index begin, Index end)
{
  TableWriter writer(begin);
  writer.addPositions(xyz_names, mesh.vertices, mesh.origin);
  if (mesh.normals.cols() > 0)
    writer.addTriple(normal_names, mesh.normals);
  if (mesh.colors.cols() > 0)
    writer.addColors(mesh.colors);
  for (const auto& [name, values] : mesh.fields)
    writer.addValues(name, values);
  return writer.take(end - begin);
}
} // namespace fresco::core
