// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/deliverables/core/plan_drawing.h>
namespace fresco::drawing {
enum class Layer { rooms, section, walls, unseen, doors, windows, marks };

/// How a layer looks.
struct Style {
  const char* name;    ///< in a DXF file
  int dxf_color;       ///< AutoCAD colour index
  std::uint32_t color; ///< 0xRRGGBB
  double width;        ///< metres; 0 = filled
};
const Style& styleOf(Layer layer);

struct Line {
  Layer layer;
  Polyline points;
};

struct Text {
  Layer layer;
  Eigen::Vector2d at; ///< middle of its base line
  double height;      ///< metres
  std::string words;  ///< ASCII
};

/// All of a plan, in the order in which it is drawn.
struct Drawing {
  std::vector<Line> lines;
  std::vector<Text> texts;
  Eigen::Matrix2Xd points;
  Eigen::Vector2d low, high; ///< of the sheet, metres
};
Drawing drawingOf(const FloorPlan& plan, const std::vector<PlanMark>& marks);

/// Parts of a wall that no door or window is in.
std::vector<Polyline> solidParts(const PlanWall& wall);
} // namespace fresco::drawing
