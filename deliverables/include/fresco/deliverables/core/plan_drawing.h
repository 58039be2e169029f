// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/image.h>
#include <fresco/core/textured_mesh.h>
#include <fresco/deliverables/core/plan.h>
#include <string>
namespace fresco {
/// A place in a plan with a name, such as a station of the scanner.
struct PlanMark {
  Eigen::Vector2d at; ///< metres
  std::string name;
};

/// Scalable drawing in metres (one unit of its coordinates is a metre, y upwards by a group that turns it), printed at
/// 1 : 100, with a scale bar. Rooms are numbered from 1, as in planJson().
FRESCO_EXPORT std::string planSvg(const FloorPlan& plan, const std::vector<PlanMark>& marks = {});

/// DXF of AutoCAD R12 in metres: POLYLINE, LINE, POINT and TEXT on the layers ROOMS, SECTION, WALLS, UNSEEN, DOORS, WINDOWS.
FRESCO_EXPORT std::string planDxf(const FloorPlan& plan);

/// A picture with known size of its pixels.
struct ScaledPicture {
  Image image;
  double pixel = 0;                     ///< metres
  Eigen::Vector2d first_pixel = {0, 0}; ///< x, y of the centre of the upper left one, metres
};

/// The drawing as a picture. @throws std::invalid_argument if `pixel` is not above 0 or asks for more than 2^28 pixels
FRESCO_EXPORT ScaledPicture planPicture(const FloorPlan& plan, double pixel);

/// What is below the cut of a plan, seen from infinitely high above: of what lies above each other the highest counts. White where
/// there is nothing. A mesh without texture shows its vertices' colours.
/// @param pixel metres. @throws std::invalid_argument as planPicture(), and if the model is not valid or has no colour
FRESCO_EXPORT ScaledPicture orthophoto(const TexturedMesh& model, const FloorPlan& plan, double pixel);
/// The same of a cloud with colours; gaps of up to two pixels are closed.
FRESCO_EXPORT ScaledPicture orthophoto(const PointSet& cloud, const FloorPlan& plan, double pixel);

/// World file (.pgw): six numbers that place the picture for geographic information systems.
FRESCO_EXPORT std::string worldFile(const ScaledPicture& picture);

/// Rooms with area, heights, outline, walls and their deviation, doors and windows, as JSON.
FRESCO_EXPORT std::string planJson(const FloorPlan& plan);

/// A line per room: number, area, height, perimeter, doors, windows, position of its label.
FRESCO_EXPORT std::string planCsv(const FloorPlan& plan);
} // namespace fresco
