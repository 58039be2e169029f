// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/export.h>
#include <fresco/core/point_table.h>
namespace pcl {
struct PCLPointCloud2;
}
namespace fresco::core {
/// @throws std::invalid_argument if the type is none of PCL's
FRESCO_EXPORT Scalar scalarOfField(std::uint8_t datatype);

/// Rows without padding, fields "_" left out. @throws std::invalid_argument if fields, sizes and data do not agree
FRESCO_EXPORT PointTable tableOfCloud(const pcl::PCLPointCloud2& cloud);

/// The header of the result is empty; is_dense tells whether x y z of all points are finite.
FRESCO_EXPORT pcl::PCLPointCloud2 cloudOfTable(PointTable table);
} // namespace fresco::core
