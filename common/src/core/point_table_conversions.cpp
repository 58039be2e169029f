// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <fresco/core/point_table.h>
#include <fresco/core/require.h>
namespace fresco::core {
namespace {
template <typename Body>
void forEachRow(const PointTable& table, const Body& body)
{
  parallelFor(table.rows, 0, body, rows_per_task);
}

Eigen::Vector3d readCoordinates(const PointTable& table, Points& points)
{
  const auto xyz = findTriple(table, xyz_names);
  if (!xyz)
    throw std::runtime_error("no coordinates x y z");
  const bool is_float =
      std::all_of(xyz->begin(), xyz->end(), [](const Column& column) { return column.type == Scalar::float32; });
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  if (!is_float) {
    const CoordinateBounds bounds = coordinateBounds(table, *xyz);
    if (bounds.exceedsFloat())
      origin = bounds.origin();
  }
  points.resize(3, table.rows);
  for (int axis = 0; axis < 3; ++axis)
    forEachValue(table, (*xyz)[axis], 0, [&](Index row, auto value) {
      points(axis, row) =
          origin[axis] == 0 ? static_cast<float>(value) : static_cast<float>(static_cast<double>(value) - origin[axis]);
    });
  return origin;
}

Points tripleValues(const PointTable& table, NameTriple names, const Eigen::Vector3d& origin)
{
  Points values;
  const auto columns = findTriple(table, names);
  if (!columns)
    return values;
  values.resize(3, table.rows);
  for (int axis = 0; axis < 3; ++axis)
    forEachValue(table, (*columns)[axis], 0, [&](Index row, auto value) {
      values(axis, row) = static_cast<float>(static_cast<double>(value) - origin[axis]);
    });
  return values;
}

/// A colour component of any type as 0..255: bytes as they are, 16 bit by their high byte, floats from 0..1.
template <typename T>
std::uint8_t colorByte(T value)
{
  if constexpr (std::is_floating_point_v<T>)
    return value > T(0) ? static_cast<std::uint8_t>(std::min(T(255), std::round(value * T(255)))) : std::uint8_t{0};
  else if constexpr (std::is_same_v<T, std::uint16_t>)
    return static_cast<std::uint8_t>(value >> 8);
  else
    return static_cast<std::uint8_t>(std::clamp<std::int64_t>(static_cast<std::int64_t>(value), 0, 255));
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
    for (int channel = 0; channel < 3; ++channel)
      forEachValue(table, (*rgb)[channel], 0, [&](Index row, auto value) { colors(channel, row) = colorByte(value); });
  }
  return colors;
}

Eigen::VectorXf firstOf(const PointTable& table, std::initializer_list<const char*> names)
{
  for (const char* name : names)
    if (const Column* column = table.find(name); column)
      return columnValues(table, *column);
  return {};
}

void addTriple(PointTable& table, NameTriple names, Scalar type)
{
  for (const char* name : names)
    table.addColumn(name, type);
}

template <typename T, typename Values>
void storeTriple(PointTable& table, NameTriple names, const Values& values, const Eigen::Vector3d& origin)
{
  for (int axis = 0; axis < 3; ++axis) {
    const Column column = *table.find(names[axis]);
    forEachRow(table, [&](Index row) {
      const T value = static_cast<T>(static_cast<double>(values(axis, row)) + origin[axis]);
      std::memcpy(table.cell(row, column), &value, sizeof(T));
    });
  }
}

void storePositions(PointTable& table, NameTriple names, const Points& values, const Eigen::Vector3d& origin)
{
  if (origin.isZero(0))
    storeTriple<float>(table, names, values, Eigen::Vector3d::Zero());
  else
    storeTriple<double>(table, names, values, origin);
}

void storeColors(PointTable& table, const Colors& colors)
{
  const Column column = *table.find("rgb");
  forEachRow(table, [&](Index row) {
    const std::uint32_t packed =
        std::uint32_t(colors(0, row)) << 16 | std::uint32_t(colors(1, row)) << 8 | std::uint32_t(colors(2, row));
    std::memcpy(table.cell(row, column), &packed, sizeof(packed));
  });
}

void storeValues(PointTable& table, const std::string& name, const Eigen::VectorXf& values)
{
  const Column column = *table.find(name);
  forEachRow(table, [&](Index row) { std::memcpy(table.cell(row, column), &values[row], sizeof(float)); });
}

Scalar positionType(const Eigen::Vector3d& origin) { return origin.isZero(0) ? Scalar::float32 : Scalar::float64; }

const Eigen::Vector3d no_origin = Eigen::Vector3d::Zero();

} // namespace

PointSet tableToPoints(const PointTable& table)
{
  PointSet set;
  set.origin = readCoordinates(table, set.points);
  set.normals = tripleValues(table, normal_names, no_origin);
  set.colors = readColors(table);
  set.intensities = firstOf(table, {"intensity", "intensities", "scalar_intensity", "scalar_Intensity"});
  set.confidences = firstOf(table, {"confidence"});
  set.viewpoints = tripleValues(table, viewpoint_names, set.origin);
  if (set.viewpoints.cols() == 0 && table.sensor)
    set.viewpoints = (table.sensor->position - set.origin).cast<float>();
  return set;
}

PointTable pointsToTable(const PointSet& set)
{
  validatePointSet(set);
  PointTable table;
  addTriple(table, xyz_names, positionType(set.origin));
  if (set.normals.cols() > 0)
    addTriple(table, normal_names, Scalar::float32);
  if (set.colors.cols() > 0)
    table.addColumn("rgb", Scalar::float32);
  if (set.intensities.size() > 0)
    table.addColumn("intensity", Scalar::float32);
  if (set.confidences.size() > 0)
    table.addColumn("confidence", Scalar::float32);
  const bool many_viewpoints = set.viewpoints.cols() > 1;
  if (many_viewpoints)
    addTriple(table, viewpoint_names, positionType(set.origin));
  table.allocate(set.size());
  storePositions(table, xyz_names, set.points, set.origin);
  if (set.normals.cols() > 0)
    storeTriple<float>(table, normal_names, set.normals, no_origin);
  if (set.colors.cols() > 0)
    storeColors(table, set.colors);
  if (set.intensities.size() > 0)
    storeValues(table, "intensity", set.intensities);
  if (set.confidences.size() > 0)
    storeValues(table, "confidence", set.confidences);
  if (many_viewpoints)
    storePositions(table, viewpoint_names, set.viewpoints, set.origin);
  else if (set.viewpoints.cols() == 1)
    table.sensor = SensorPose{set.origin + set.viewpoints.col(0).cast<double>(), Eigen::Quaternionf::Identity()};
  return table;
}

TriangleMesh tableToMesh(const PointTable& table)
{
  TriangleMesh mesh;
  mesh.origin = readCoordinates(table, mesh.vertices);
  mesh.normals = tripleValues(table, normal_names, no_origin);
  mesh.colors = readColors(table);
  const bool packed = packedColor(table) != nullptr;
  for (const Column& column : table.columns) {
    const std::string& name = column.name;
    const bool is_color = packed ? &column == packedColor(table)
                                 : mesh.colors.cols() > 0 && (name == "red" || name == "green" || name == "blue");
    const auto is_in = [&](NameTriple names) { return std::count(names, names + 3, name) > 0; };
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
  PointTable table;
  addTriple(table, xyz_names, positionType(mesh.origin));
  if (mesh.normals.cols() > 0)
    addTriple(table, normal_names, Scalar::float32);
  if (mesh.colors.cols() > 0)
    table.addColumn("rgb", Scalar::float32);
  for (const auto& [name, values] : mesh.fields)
    table.addColumn(name, Scalar::float32);
  table.allocate(mesh.vertexCount());
  storePositions(table, xyz_names, mesh.vertices, mesh.origin);
  if (mesh.normals.cols() > 0)
    storeTriple<float>(table, normal_names, mesh.normals, no_origin);
  if (mesh.colors.cols() > 0)
    storeColors(table, mesh.colors);
  for (const auto& [name, values] : mesh.fields)
    storeValues(table, name, values);
  return table;
}

} // namespace fresco::core
