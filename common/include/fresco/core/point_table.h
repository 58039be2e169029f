// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fresco/core/export.h>
#include <fresco/core/mesh.h>
#include <fresco/core/parallel.h>
#include <fresco/core/point_set.h>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
/// What the readers and writers of all formats share: points as rows of named columns.
namespace fresco::core {
enum class Scalar : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

/// f(T{}) with the C++ type of `type`.
template <typename Function>
auto visitScalar(Scalar type, const Function& f)
{
  return type == Scalar::int8      ? f(std::int8_t{})
         : type == Scalar::uint8   ? f(std::uint8_t{})
         : type == Scalar::int16   ? f(std::int16_t{})
         : type == Scalar::uint16  ? f(std::uint16_t{})
         : type == Scalar::int32   ? f(std::int32_t{})
         : type == Scalar::uint32  ? f(std::uint32_t{})
         : type == Scalar::int64   ? f(std::int64_t{})
         : type == Scalar::uint64  ? f(std::uint64_t{})
         : type == Scalar::float32 ? f(float{})
                                   : f(double{});
}

/// Bytes of one value.
FRESCO_EXPORT std::size_t scalarSize(Scalar type);

template <typename T>
T loadScalar(const void* at)
{
  T value;
  std::memcpy(&value, at, sizeof(T));
  return value;
}

struct Column {
  std::string name;
  Scalar type = Scalar::float32;
  std::size_t count = 1;  ///< values per row, >= 1
  std::size_t offset = 0; ///< bytes from the begin of a row
  double full = 0;        ///< of red green blue: the value that shows as 255; 0 = judged by type and values

  std::size_t bytes() const { return count * scalarSize(type); }
};

/// Where a cloud was seen from.
struct SensorPose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaternionf orientation = Eigen::Quaternionf::Identity();
};

/// Rows of little-endian values. Columns bear PCL's names: x y z, normal_x normal_y normal_z, rgb (float32, packed
/// 0RGB) or rgba (uint32, packed ARGB), intensity, confidence, vp_x vp_y vp_z, anything else.
struct FRESCO_EXPORT PointTable {
  std::vector<Column> columns;
  std::size_t stride = 0; ///< bytes per row
  Index rows = 0;
  Index width = 0, height = 0; ///< of an organised cloud, width * height = rows; 0 = not organised
  std::vector<std::uint8_t> data;
  const std::uint8_t* view = nullptr; ///< rows to be read only, owned by somebody else, instead of `data`
  std::optional<SensorPose> sensor;

  const Column* find(std::string_view name) const; ///< nullptr if there is none
  const std::uint8_t* rowsBegin() const { return view ? view : data.data(); }
  const std::uint8_t* cell(Index row, const Column& column) const
  {
    return rowsBegin() + static_cast<std::size_t>(row) * stride + column.offset;
  }
  std::uint8_t* cell(Index row, const Column& column)
  {
    return data.data() + static_cast<std::size_t>(row) * stride + column.offset;
  }
  /// Appends a column to the layout; before data is allocated. A name that is taken gets the number of its column.
  /// @throws std::runtime_error beyond 10,000 columns, or if that name is taken, too
  void addColumn(const std::string& name, Scalar type, std::size_t count = 1);
  void allocate(Index row_count); ///< zeros
  void own();                     ///< copies what `view` shows into `data`
};

/// A mesh as files hold it.
struct MeshTable {
  PointTable vertices; ///< columns by standardName()
  Faces faces;         ///< polygons as fans, strips as triangles
};

/// body(row, T value) with component `component` of `column` of the rows begin .. end - 1.
template <typename Body>
void forEachValue(const PointTable& table, const Column& column, std::size_t component, const Body& body, Index begin,
                  Index end)
{
  visitScalar(column.type, [&](auto zero) {
    using T = decltype(zero);
    const std::uint8_t* at = table.cell(begin, column) + component * sizeof(T);
    for (Index row = begin; row < end; ++row, at += table.stride)
      body(row, loadScalar<T>(at));
  });
}

/// Rows that are converted in one go; a table with fewer starts no thread.
inline constexpr Index rows_per_task = Index{1} << 16;

/// body(row, T value) of every row, in parallel: a body writes only what belongs to its row.
template <typename Body>
void forEachValue(const PointTable& table, const Column& column, std::size_t component, const Body& body)
{
  const auto part = [&](Index begin, Index end) { forEachValue(table, column, component, body, begin, end); };
  parallelRanges(table.rows, 0, part, rows_per_task);
}

/// body(row, T value) of every row, one after the other.
template <typename Body>
void eachValue(const PointTable& table, const Column& column, const Body& body)
{
  forEachValue(table, column, 0, body, 0, table.rows);
}

FRESCO_EXPORT double valueAt(const PointTable& table, Index row, const Column& column);

/// Whole numbers are rounded and kept within their range, NaN is 0 there.
FRESCO_EXPORT void storeValue(Scalar type, double value, void* at);

/// Adds the columns of another table that `wanted(column)`, without rows.
template <typename Wanted>
void addColumns(const PointTable& from, PointTable& to, const Wanted& wanted)
{
  for (const Column& column : from.columns)
    if (wanted(column))
      to.addColumn(column.name, column.type, column.count);
}

/// Copies the rows of `from` into those of `to` from `begin` on: the columns that both have. Types may differ.
FRESCO_EXPORT void copyRows(const PointTable& from, PointTable& to, Index begin = 0);

/// Of each row, whether x y z are finite.
FRESCO_EXPORT std::vector<bool> finiteRows(const PointTable& table);

/// Value `component` of every row as float, N.
FRESCO_EXPORT Eigen::VectorXf columnValues(const PointTable& table, const Column& column, std::size_t component = 0);

/// Columns of these names with one value each; nothing unless all three are there.
using NameTriple = const char* const (&)[3];
FRESCO_EXPORT std::optional<std::array<Column, 3>> findTriple(const PointTable& table, NameTriple names);
inline constexpr const char* xyz_names[3] = {"x", "y", "z"};
inline constexpr const char* normal_names[3] = {"normal_x", "normal_y", "normal_z"};
inline constexpr const char* viewpoint_names[3] = {"vp_x", "vp_y", "vp_z"};
inline constexpr const char* color_names[3] = {"red", "green", "blue"};

/// What every reader calls a column that programs name `name`: "nx" and "NormalX" are normal_x, "R" is red. Names without
/// a meaning here stay as they are.
FRESCO_EXPORT std::string standardName(std::string_view name);

/// The value of a colour that shows as 255, by the type of its fields and the largest value in them: fractions are floats
/// of which none is above 1; whole numbers of more than 8 bits stand for 8 where none is above 255.
FRESCO_EXPORT double fullColor(Scalar type, double largest);
/// The same of the columns of a table, by Column::full where that is known.
FRESCO_EXPORT double fullColor(const PointTable& table, const std::array<Column, 3>& rgb);

/// 0..255; values of more than 8 bits by their highest 8 bits, NaN as 0.
inline std::uint8_t colorByte(double value, double full)
{
  const double byte = full > 255 ? std::floor(256 * value / (full + 1)) : std::round(255 * value / full);
  return byte > 0 ? std::min(byte, 255.0) : 0.0;
}

/// The largest finite value of columns; 0 if there is none above.
FRESCO_EXPORT double largestValue(const PointTable& table, const std::array<Column, 3>& columns);

/// Makes columns red green blue of whatever type bytes, by fullColor(), and whole numbers in a float column rgb the packed
/// colour that they mean.
FRESCO_EXPORT void normalizeColors(PointTable& table);

/// Column rgb or rgba of four bytes, nullptr if there is none.
FRESCO_EXPORT const Column* packedColor(const PointTable& table);

/// Joins byte columns red green blue (and alpha) into PCL's packed rgb (rgba), as PCL's own readers do, unless a column
/// has that name already.
FRESCO_EXPORT void packColors(PointTable& table);

/// Replaces packed rgb (rgba) by byte columns red green blue (and alpha), unless a column has such a name already.
FRESCO_EXPORT void unpackColors(PointTable& table);

/// Bounds of finite coordinates and what rounding them to float loses.
struct FRESCO_EXPORT CoordinateBounds {
  Eigen::Array3d low = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  Eigen::Array3d loss = Eigen::Array3d::Zero();

  double extent() const;     ///< longest side, >= 0
  bool exceedsFloat() const; ///< float loses more than 1e-6 of the extent
  /// Centre of the bounds, rounded to a power of two near the extent: short to write and exact to add.
  Eigen::Vector3d origin() const;
};
FRESCO_EXPORT CoordinateBounds coordinateBounds(const PointTable& table, const std::array<Column, 3>& xyz);

/// Values of `names`, row by row, as float32, red green blue as uint8 by fullColor(); x y z and vp_x vp_y vp_z as float64
/// where float loses more than 1e-6 of the extent of x y z. Columns without a name are left out.
FRESCO_EXPORT PointTable tableOfRows(const std::vector<std::string>& names, const std::vector<double>& values);

/// x y z and vp_x vp_y vp_z become float32 where that loses no more than 1e-6 of the extent.
FRESCO_EXPORT void narrowCoordinates(PointTable& table);

/// Takes `origin` off x y z, which become float64.
FRESCO_EXPORT void moveOrigin(PointTable& table, const Eigen::Vector3d& origin);

/// @throws std::runtime_error if x y z are missing
FRESCO_EXPORT PointSet tableToPoints(const PointTable& table);
/// The same relative to a given origin.
FRESCO_EXPORT PointSet tableToPoints(const PointTable& table, const Eigen::Vector3d& origin);
FRESCO_EXPORT PointTable pointsToTable(const PointSet& set);

/// Vertices with their attributes, and faces. @throws std::runtime_error if x y z are missing
FRESCO_EXPORT TriangleMesh tableToMesh(const PointTable& table, Faces faces = {});
/// Vertices and their attributes.
FRESCO_EXPORT PointTable meshToTable(const TriangleMesh& mesh);

/// Vertices begin .. end - 1 of a mesh that is sound.
FRESCO_EXPORT PointTable verticesToTable(const TriangleMesh& mesh, Index begin, Index end);
} // namespace fresco::core
/// Readers and writers work on these tables.
namespace fresco::io {
using namespace fresco::core;
}
