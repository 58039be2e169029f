// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/drawing.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fresco/core/require.h>
namespace fresco::drawing {
using Eigen::Vector2d;

namespace {
Polyline between(const Vector2d& a, const Vector2d& b)
{
  Polyline line(2, 2);
  line << a, b;
  return line;
}

std::string number(double value, int digits)
{
  char text[64];
  std::snprintf(text, sizeof(text), "%.*f", digits, value);
  return text;
}

void addWall(const PlanWall& wall, Drawing& out)
{
  const Layer layer = wall.seen ? Layer::walls : Layer::unseen;
  for (const Polyline& part : solidParts(wall))
    out.lines.push_back({layer, part});
  for (const PlanOpening& opening : wall.openings) {
    const Layer kind = opening.is_door ? Layer::doors : Layer::windows;
    out.lines.push_back({kind, between(opening.from, opening.to)});
  }
}

/// A bar of 1, 2 or 5 times a power of ten metres below the plan.
void addScaleBar(double text, Drawing& out)
{
  const double most = std::max(0.25 * (out.high.x() - out.low.x()), 0.1);
  const double power = std::pow(10, std::floor(std::log10(most)));
  const double length = power * (most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1);
  const Vector2d at(out.low.x(), out.low.y() - 2 * text);
  const Vector2d tick(0, 0.5 * text), end = at + Vector2d(length, 0);
  Polyline bar(2, 4);
  bar << at + tick, at, end, end + tick;
  out.lines.push_back({Layer::marks, bar});
  out.texts.push_back({Layer::marks, (at + end) / 2 + 0.3 * tick, text, number(length, length < 1 ? 2 : 0) + " m"});
  out.low.y() = at.y();
}
} // namespace

const Style& styleOf(Layer layer)
{
  static const Style styles[] = {{"ROOMS", 4, 0xe3eef7, 0},    {"SECTION", 8, 0x8a8a8a, 0.008},
                                 {"WALLS", 7, 0x111111, 0.05}, {"UNSEEN", 6, 0xb08ab0, 0.02},
                                 {"DOORS", 3, 0x2e8b57, 0.02}, {"WINDOWS", 5, 0x2f6fbf, 0.03},
                                 {"MARKS", 1, 0x333333, 0.015}};
  return styles[static_cast<std::size_t>(layer)];
}

std::vector<Polyline> solidParts(const PlanWall& wall)
{
  std::vector<Polyline> parts;
  Vector2d from = wall.from;
  for (const PlanOpening& opening : wall.openings) { // in their order along the wall
    if ((opening.from - from).norm() > 1e-9)
      parts.push_back(between(from, opening.from));
    from = opening.to;
  }
  if ((wall.to - from).norm() > 1e-9)
    parts.push_back(between(from, wall.to));
  return parts;
}

Drawing drawingOf(const FloorPlan& plan, const std::vector<PlanMark>& marks)
{
  Drawing out;
  out.low = plan.low;
  out.high = plan.high;
  out.points = plan.points;
  const double text = std::clamp(0.016 * (plan.high - plan.low).norm(), 0.05, 1.0); // metres: legible on one sheet
  for (const PlanRoom& room : plan.rooms)
    out.lines.push_back({Layer::rooms, room.outline});
  for (const Polyline& line : plan.section)
    out.lines.push_back({Layer::section, line});
  for (std::size_t r = 0; r < plan.rooms.size(); ++r) {
    const PlanRoom& room = plan.rooms[r];
    for (const PlanWall& wall : room.walls)
      addWall(wall, out);
    out.texts.push_back({Layer::rooms, room.label + Vector2d(0, 0.7 * text), 1.3 * text, std::to_string(r + 1)});
    out.texts.push_back({Layer::rooms, room.label - Vector2d(0, 0.7 * text), text, number(room.area, 2) + " m2"});
    if (room.ceiling > room.floor)
      out.texts.push_back({Layer::rooms, room.label - Vector2d(0, 2.1 * text), text,
                           "h " + number(room.ceiling - room.floor, 2) + " m"});
  }
  for (const PlanMark& mark : marks) {
    const double half = 0.4 * text;
    for (const Vector2d& arm : {Vector2d(half, half), Vector2d(half, -half)})
      out.lines.push_back({Layer::marks, between(mark.at - arm, mark.at + arm)});
    out.texts.push_back({Layer::marks, mark.at + Vector2d(0, 0.6 * text), 0.8 * text, mark.name});
  }
  addScaleBar(text, out);
  out.low.array() -= text;
  out.high.array() += text;
  return out;
}
} // namespace fresco::drawing
