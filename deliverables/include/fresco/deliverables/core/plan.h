// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <fresco/core/export.h>
#include <fresco/core/mesh.h>
#include <fresco/core/point_set.h>
#include <fresco/core/progress.h>
#include <limits>
#include <vector>
namespace fresco {
using Polyline = Eigen::Matrix2Xd; ///< 2xK, metres; closed where the last point is the first one

struct PlanOptions {
  /// Of the cut, along `up`, metres in the frame of the model; NaN = 1.5 m above the floor of the lowest storey.
  double height = std::numeric_limits<double>::quiet_NaN();
  double tolerance = 0.01; ///< metres that the data may lie off a straight wall or a main direction, above 0, up to 0.1
  double cell = 0;   ///< of the grid that rooms are found in, metres, 0.005..0.2; 0 = from the density of the data
  double door = 1.1; ///< widest passage that ends a room where no lintel does, metres, 0.3..5
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ(); ///< any length above 0
  int threads = 0;                               ///< 0 = all cores; the result does not depend on it
};

/// A door or window: where the surface of a wall is missing at the height of the cut and nothing stands before it.
struct PlanOpening {
  Eigen::Vector2d from = {0, 0}, to = {0, 0}; ///< on the line of the wall, metres
  double sill = 0, head = 0;                  ///< lower and upper end, metres above the room's floor
  bool is_door = false;                       ///< it reaches down to the floor
  int beyond = -1;                            ///< room on the other side, -1 = none
};

/// One edge of a room's outline, the room on its left.
struct PlanWall {
  Eigen::Vector2d from = {0, 0}, to = {0, 0};
  bool straight = false; ///< the data lie within the tolerance (nine tenths of them) of this line
  bool seen = true;      ///< false: no data here, the outline is closed over a gap
  double rms = 0;        ///< deviation of the data from the line, metres
  double worst = 0;      ///< 95 % of the data lie nearer, metres
  std::vector<PlanOpening> openings;
};

struct PlanRoom {
  Polyline outline;               ///< counter-clockwise, closed
  std::vector<Polyline> columns;  ///< clockwise, closed: what stands in the room from floor to ceiling
  double area = 0;                ///< square metres, without the columns
  double floor = 0, ceiling = 0;  ///< along `up`, metres; equal where no ceiling was seen
  std::vector<PlanWall> walls;    ///< edges of the outline and of the columns
  Eigen::Vector2d label = {0, 0}; ///< inside, far from all walls
};

/// Doors, or windows, in the walls of a room.
inline int countOpenings(const PlanRoom& room, bool doors)
{
  int count = 0;
  for (const PlanWall& wall : room.walls)
    for (const PlanOpening& opening : wall.openings)
      count += opening.is_door == doors;
  return count;
}

/// Horizontal plan of one storey. x and y are those of the model where `up` is its z axis.
struct FloorPlan {
  Eigen::Isometry3d T_plan_model = Eigen::Isometry3d::Identity(); ///< turns `up` to z and the floor level
  double height = 0, floor = 0, ceiling = 0;                      ///< of the cut and of the storey, along `up`, metres
  bool has_ceiling = false;       ///< false: none was seen, walls are those at the height of the cut
  double tolerance = 0, cell = 0; ///< as used, metres
  std::vector<double> directions; ///< main directions of the walls, degrees, 0 up to 90; the longest walls first
  std::vector<Polyline> section;  ///< of a mesh: where the plane of the cut meets it, the free side on the left
  Eigen::Matrix2Xd points;        ///< of a cloud: points near that plane, one per cell
  std::vector<PlanRoom> rooms;    ///< the largest first
  Eigen::Vector2d low = {0, 0}, high = {0, 0}; ///< bounding box of all lines

  bool empty() const { return section.empty() && points.cols() == 0 && rooms.empty(); }
};

/// Plan of a mesh in metres: its section at a height, rooms with straight walls, doors and windows.
///
/// Walls are looked for below the ceiling, where no furniture stands and lintels close doors. Rooms are the basins of a
/// watershed of the distance to walls (Meyer 1994, "Topographic distance and watershed lines") where floor or ceiling were
/// seen; their outlines are straightened edge by edge (Douglas & Peucker 1973; least squares with Cauchy's weights) and
/// follow the main directions of the building where that moves no end by more than the tolerance. Doors and windows
/// are holes in the surface of a wall that nothing stands before (Adan & Huber 2011, "3D reconstruction of interior wall
/// surfaces under occlusion and clutter").
/// @throws std::invalid_argument if the mesh is not valid or has no faces, an option is out of range, or the height is
///         outside of the model: the message says the range
FRESCO_EXPORT FloorPlan drawPlan(const TriangleMesh& mesh, const PlanOptions& options = {},
                                 const Progress& progress = {});

/// The same of a cloud of points, which need no normals; non-finite points are left out.
FRESCO_EXPORT FloorPlan drawPlan(const PointSet& cloud, const PlanOptions& options = {}, const Progress& progress = {});

/// Where the plane  axis . x = offset  cuts a mesh: polylines, chained over shared edges; seen from the tip of `axis` the
/// free side of the surface is on the left. Closed where the mesh is.
/// @param axis unit, in the frame of the mesh. @return 3xK each, metres in the frame of the mesh, its origin added
/// @throws std::invalid_argument if the mesh is not valid or `axis` is not of unit length
FRESCO_EXPORT std::vector<Eigen::Matrix3Xd> cutMesh(const TriangleMesh& mesh, const Eigen::Vector3d& axis,
                                                    double offset);
} // namespace fresco
