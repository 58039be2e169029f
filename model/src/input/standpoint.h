// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <fresco/core/point_set.h>
#include <fresco/io/scan_file.h>
#include <string>
namespace fresco::model {
/// From where the points of a scan were seen.
enum class Standpoint { origin, many, unknown };

struct Standing {
  Standpoint from = Standpoint::unknown;
  Eigen::AlignedBox3f box; ///< of the points, in the frame of the file; empty where these were not asked
};

/// What the file says of the sensor, else the points: almost nothing is hidden behind something else for one who stands where a
/// scan was taken. Points farther from the origin than they extend, or all within 0.3 m of it, were not measured from there. Up to four million are read.
/// @throws std::runtime_error as readPoints(), and if there is no point
Standing standpointOf(const ScanPath& scan);

/// Whether a set's viewpoints say something: PCL writes one at the origin into every PCD file, whatever it was seen from.
bool tellsViewpoint(const PointSet& set);

/// Whether a file holds a surface, whose points are to be spread over its faces: of PLY its header tells; OBJ always, since a
/// scanner exports it only so.
bool holdsFaces(const std::string& file);

/// Up to 200,000 points of a scan, finite, spread over what is read of it. @throws as standpointOf()
Points samplePoints(const ScanPath& scan);

/// Share of the points that have about the same direction from the origin as their neighbour in direction, and a range that is
/// different by a tenth, 0..1.
/// @param points 3xN, finite, N >= 2
double hiddenShare(const Points& points);
} // namespace fresco::model
