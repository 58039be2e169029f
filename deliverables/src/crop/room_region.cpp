// SPDX-License-Identifier: BSD-3-Clause
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <cmath>
#include <fresco/core/require.h>
#include <fresco/deliverables/core/crop.h>
namespace fresco {
namespace {
namespace bg = boost::geometry;
using Point = bg::model::d2::point_xy<double>;
using Polygon = bg::model::polygon<Point, false>; // counter-clockwise
using Ring = Polygon::ring_type;

Ring ringOf(const Polyline& line)
{
  Ring ring;
  for (Index k = 0; k < line.cols(); ++k)
    ring.emplace_back(line(0, k), line(1, k));
  return ring;
}

/// Without the first point again at the end.
Eigen::Matrix2Xd outlineOf(const Ring& ring)
{
  Eigen::Matrix2Xd outline(2, ring.size() - 1);
  for (Index k = 0; k < outline.cols(); ++k)
    outline.col(k) << ring[k].x(), ring[k].y();
  return outline;
}

bg::model::multi_polygon<Polygon> grown(const Polygon& polygon, double margin)
{
  constexpr double longest_corner = 4; // margins; a sharper one is cut off
  bg::model::multi_polygon<Polygon> result;
  bg::buffer(polygon, result, bg::strategy::buffer::distance_symmetric<double>(margin),
             bg::strategy::buffer::side_straight(), bg::strategy::buffer::join_miter(longest_corner),
             bg::strategy::buffer::end_flat(), bg::strategy::buffer::point_square());
  return result;
}
} // namespace

CropRegion regionOfRoom(const FloorPlan& plan, const RoomChoice& choice)
{
  const int rooms = static_cast<int>(plan.rooms.size());
  require(choice.number >= 1 && choice.number <= rooms, "crop: room ", choice.number, " of ", rooms,
          rooms == 1 ? " room" : " rooms");
  require(choice.margin >= 0 && std::isfinite(choice.margin), "crop: a margin of ", choice.margin, " m");
  const PlanRoom& room = plan.rooms[choice.number - 1];
  Polygon polygon;
  polygon.outer() = ringOf(room.outline);
  for (const Polyline& column : room.columns)
    polygon.inners().push_back(ringOf(column));
  CropRegion region;
  const auto add = [&](const Polygon& part) {
    region.outlines.push_back(outlineOf(part.outer()));
    for (const Ring& hole : part.inners())
      region.outlines.push_back(outlineOf(hole));
  };
  if (choice.margin > 0)
    for (const Polygon& part : grown(polygon, choice.margin))
      add(part);
  else
    add(polygon);
  region.low = std::min(room.floor, plan.floor) - choice.margin;
  if (plan.has_ceiling)
    region.high = std::max(room.ceiling, plan.ceiling) + choice.margin;
  region.T_region_world = plan.T_plan_model;
  return region;
}
} // namespace fresco
