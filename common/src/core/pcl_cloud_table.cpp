// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <fresco/core/pcl_cloud_table.h>
#include <fresco/core/require.h>
#include <limits>
#include <pcl/PCLPointCloud2.h>
namespace fresco::core {
namespace {
using Field = pcl::PCLPointField;

constexpr std::pair<std::uint8_t, Scalar> field_types[] = {
    {Field::INT8, Scalar::int8},       {Field::UINT8, Scalar::uint8},   {Field::INT16, Scalar::int16},
    {Field::UINT16, Scalar::uint16},   {Field::INT32, Scalar::int32},   {Field::UINT32, Scalar::uint32},
    {Field::INT64, Scalar::int64},     {Field::UINT64, Scalar::uint64}, {Field::FLOAT32, Scalar::float32},
    {Field::FLOAT64, Scalar::float64}, {Field::BOOL, Scalar::uint8}};

std::uint8_t fieldType(Scalar scalar)
{
  return std::find_if(std::begin(field_types), std::end(field_types),
                      [&](auto& entry) { return entry.second == scalar; })
      ->first;
}
} // namespace

Scalar scalarOfField(std::uint8_t datatype)
{
  for (const auto& [known, scalar] : field_types)
    if (known == datatype)
      return scalar;
  throw std::invalid_argument(concat("cloud: unknown field type ", int{datatype}));
}

PointTable tableOfCloud(const pcl::PCLPointCloud2& cloud)
{
  require(!cloud.is_bigendian, "cloud: big-endian data");
  const std::size_t rows = std::size_t{cloud.width} * cloud.height;
  require(cloud.height <= 1 || std::size_t{cloud.row_step} >= std::size_t{cloud.width} * cloud.point_step,
          "cloud: row_step ", cloud.row_step, " is too small");
  const std::size_t last_row = cloud.height > 0 ? (cloud.height - std::size_t{1}) * cloud.row_step : 0;
  require(rows == 0 || cloud.data.size() >= last_row + std::size_t{cloud.width} * cloud.point_step,
          "cloud: ", cloud.data.size(), " bytes of data are too few for ", cloud.width, " x ", cloud.height, " points");
  PointTable table, stored; // the second as rows lie in the cloud
  for (const Field& field : cloud.fields) {
    const std::size_t count = std::max<std::size_t>(field.count, 1);
    const Scalar type = scalarOfField(field.datatype);
    require(field.offset + count * scalarSize(type) <= cloud.point_step, "cloud: field ", field.name,
            " lies outside of the point");
    if (field.name == "_")
      continue;
    table.addColumn(field.name, type, count);
    stored.columns.push_back(table.columns.back());
    stored.columns.back().offset = field.offset;
  }
  table.allocate(rows);
  stored.stride = cloud.point_step;
  const bool has_gaps = cloud.row_step != std::size_t{cloud.width} * cloud.point_step;
  stored.rows = has_gaps ? cloud.width : rows;
  for (std::size_t row = 0; row < rows; row += stored.rows) {
    stored.view = cloud.data.data() + row / cloud.width * cloud.row_step;
    copyRows(stored, table, row);
  }
  if (cloud.height > 1) {
    table.width = cloud.width;
    table.height = cloud.height;
  }
  return table;
}

pcl::PCLPointCloud2 cloudOfTable(PointTable table)
{
  pcl::PCLPointCloud2 cloud;
  constexpr std::size_t most = std::numeric_limits<pcl::uindex_t>::max(); // of every number in a PCL cloud
  const std::size_t columns = table.height > 1 ? table.width : 1;
  require(static_cast<std::size_t>(table.rows) <= most && table.stride <= most / std::max<std::size_t>(columns, 1),
          "cloud: ", table.rows, " points of ", table.stride, " bytes are too many for a PCL cloud");
  for (const Column& column : table.columns) {
    Field field;
    field.name = column.name;
    field.offset = column.offset;
    field.datatype = fieldType(column.type);
    field.count = column.count;
    cloud.fields.push_back(field);
  }
  const bool organised = table.height > 0;
  cloud.width = organised ? table.width : table.rows;
  cloud.height = organised ? table.height : 1;
  cloud.point_step = table.stride;
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.is_bigendian = false;
  const std::vector<bool> finite = finiteRows(table);
  cloud.is_dense = std::find(finite.begin(), finite.end(), false) == finite.end();
  cloud.data = std::move(table.data);
  return cloud;
}
} // namespace fresco::core
