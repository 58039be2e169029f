// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "point_io_table.h"
namespace pcl {
struct PCLPointCloud2;
}
namespace fresco::detail {
/// @throws std::invalid_argument if the type is none of PCL's
Scalar scalarOfField(std::uint8_t datatype);

/// Rows without padding, fields "_" left out. @throws std::invalid_argument if fields, sizes and data do not agree
PointTable tableOfCloud(const pcl::PCLPointCloud2& cloud);

/// The header of the result is empty; is_dense tells whether x y z of all points are finite.
pcl::PCLPointCloud2 cloudOfTable(PointTable table);
} // namespace fresco::detail
