// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/drawing.h"
#include <fresco/io/file.h>
#include <fresco/io/json_text.h>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>
namespace fresco {
using namespace drawing;

namespace {
using Json = nlohmann::ordered_json;

std::ostringstream fixedText(int digits)
{
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits);
  return text;
}

std::string webColor(std::uint32_t color)
{
  std::ostringstream text;
  text << '#' << std::hex << std::setw(6) << std::setfill('0') << color;
  return text.str();
}

/// "m2" with a raised 2, and without what would be read as tags.
std::string webText(const std::string& words)
{
  std::string out;
  for (const char c : words)
    out += c == '<' ? "&lt;" : c == '&' ? "&amp;" : c == '>' ? "&gt;" : std::string(1, c);
  if (out.size() > 3 && out.compare(out.size() - 3, 3, " m2") == 0)
    out.replace(out.size() - 1, 1, "\u00b2");
  return out;
}

Json listOf(const Eigen::Vector2d& p) { return {p.x(), p.y()}; }

Json listOf(const Polyline& line)
{
  Json list = Json::array();
  for (Index k = 0; k < line.cols(); ++k)
    list.push_back(listOf(Eigen::Vector2d(line.col(k))));
  return list;
}

Json wallJson(const PlanWall& wall)
{
  Json openings = Json::array();
  for (const PlanOpening& opening : wall.openings)
    openings.push_back({{"kind", opening.is_door ? "door" : "window"},
                        {"from", listOf(opening.from)},
                        {"to", listOf(opening.to)},
                        {"width", (opening.to - opening.from).norm()},
                        {"sill", opening.sill},
                        {"head", opening.head},
                        {"to_room", opening.beyond < 0 ? Json() : Json(opening.beyond + 1)}});
  return {{"from", listOf(wall.from)}, {"to", listOf(wall.to)},     {"seen", wall.seen},
          {"straight", wall.straight}, {"rms_mm", 1000 * wall.rms}, {"within_95_percent_mm", 1000 * wall.worst},
          {"openings", openings}};
}

double perimeterOf(const PlanRoom& room)
{
  double sum = 0;
  for (Index k = 0; k + 1 < room.outline.cols(); ++k)
    sum += (room.outline.col(k + 1) - room.outline.col(k)).norm();
  return sum;
}

void dxfLine(std::ostringstream& dxf, const Line& line)
{
  const char* layer = styleOf(line.layer).name;
  const Index last = line.points.cols() - 1;
  const bool closed = last > 1 && line.points.col(0) == line.points.col(last);
  dxf << "0\nPOLYLINE\n8\n" << layer << "\n66\n1\n70\n" << (closed ? 1 : 0) << "\n10\n0\n20\n0\n30\n0\n";
  for (Index k = 0; k < (closed ? last : last + 1); ++k)
    dxf << "0\nVERTEX\n8\n" << layer << "\n10\n" << line.points(0, k) << "\n20\n" << line.points(1, k) << "\n30\n0\n";
  dxf << "0\nSEQEND\n8\n" << layer << '\n';
}
} // namespace

std::string planSvg(const FloorPlan& plan, const std::vector<PlanMark>& marks)
{
  const Drawing drawing = drawingOf(plan, marks);
  const Eigen::Vector2d size = drawing.high - drawing.low;
  std::ostringstream svg = fixedText(4);
  svg << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << 10 * size.x() << "mm\" height=\"" << 10 * size.y()
      << "mm\" viewBox=\"" << drawing.low.x() << ' ' << -drawing.high.y() << ' ' << size.x() << ' ' << size.y()
      << "\" font-family=\"sans-serif\" text-anchor=\"middle\">\n<title>Floor plan, metres</title>\n"
      << "<g transform=\"scale(1 -1)\" fill=\"none\" stroke-linejoin=\"round\">\n";
  for (const Line& line : drawing.lines) {
    const Style& style = styleOf(line.layer);
    svg << "<polyline class=\"" << style.name << "\" ";
    if (style.width > 0)
      svg << "stroke=\"" << webColor(style.color) << "\" stroke-width=\"" << style.width << "\" points=\"";
    else
      svg << "fill=\"" << webColor(style.color) << "\" points=\"";
    for (Index k = 0; k < line.points.cols(); ++k)
      svg << (k > 0 ? " " : "") << line.points(0, k) << ',' << line.points(1, k);
    svg << "\"/>\n";
  }
  if (drawing.points.cols() > 0) {
    svg << "<path class=\"SECTION\" stroke=\"" << webColor(styleOf(Layer::section).color)
        << "\" stroke-width=\"0.015\" stroke-linecap=\"round\" d=\"";
    for (Index k = 0; k < drawing.points.cols(); ++k)
      svg << 'M' << drawing.points(0, k) << ' ' << drawing.points(1, k) << "h0";
    svg << "\"/>\n";
  }
  svg << "</g>\n";
  for (const Text& text : drawing.texts)
    svg << "<text x=\"" << text.at.x() << "\" y=\"" << -text.at.y() << "\" font-size=\"" << text.height << "\">"
        << webText(text.words) << "</text>\n";
  return svg.str() + "</svg>\n";
}

std::string planDxf(const FloorPlan& plan)
{
  const Drawing drawing = drawingOf(plan, {});
  std::ostringstream dxf = fixedText(6);
  dxf << "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n9\n$EXTMIN\n10\n"
      << drawing.low.x() << "\n20\n"
      << drawing.low.y() << "\n30\n0\n9\n$EXTMAX\n10\n"
      << drawing.high.x() << "\n20\n"
      << drawing.high.y() << "\n30\n0\n0\nENDSEC\n0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLAYER\n70\n7\n";
  for (int k = 0; k <= static_cast<int>(Layer::marks); ++k) {
    const Style& style = styleOf(static_cast<Layer>(k));
    dxf << "0\nLAYER\n2\n" << style.name << "\n70\n0\n62\n" << style.dxf_color << "\n6\nCONTINUOUS\n";
  }
  dxf << "0\nENDTAB\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";
  for (const Line& line : drawing.lines)
    dxfLine(dxf, line);
  for (Index k = 0; k < drawing.points.cols(); ++k)
    dxf << "0\nPOINT\n8\nSECTION\n10\n" << drawing.points(0, k) << "\n20\n" << drawing.points(1, k) << "\n30\n0\n";
  for (const Text& text : drawing.texts)
    dxf << "0\nTEXT\n8\n"
        << styleOf(text.layer).name << "\n10\n"
        << text.at.x() << "\n20\n"
        << text.at.y() << "\n30\n0\n40\n"
        << text.height << "\n1\n"
        << text.words << "\n72\n1\n11\n"
        << text.at.x() << "\n21\n"
        << text.at.y() << "\n31\n0\n";
  return dxf.str() + "0\nENDSEC\n0\nEOF\n";
}

std::string planJson(const FloorPlan& plan)
{
  Json json{
      {"height", plan.height},       {"floor", plan.floor}, {"ceiling", plan.has_ceiling ? Json(plan.ceiling) : Json()},
      {"tolerance", plan.tolerance}, {"cell", plan.cell},   {"directions_degrees", plan.directions},
      {"rooms", Json::array()}};
  for (std::size_t r = 0; r < plan.rooms.size(); ++r) {
    const PlanRoom& room = plan.rooms[r];
    Json columns = Json::array(), walls = Json::array();
    for (const Polyline& column : room.columns)
      columns.push_back(listOf(column));
    for (const PlanWall& wall : room.walls)
      walls.push_back(wallJson(wall));
    json["rooms"].push_back({{"room", r + 1},
                             {"area", room.area},
                             {"perimeter", perimeterOf(room)},
                             {"height", room.ceiling > room.floor ? Json(room.ceiling - room.floor) : Json()},
                             {"floor", room.floor},
                             {"label", listOf(room.label)},
                             {"outline", listOf(room.outline)},
                             {"columns", columns},
                             {"walls", walls}});
  }
  return jsonText(json, 2);
}

std::string planCsv(const FloorPlan& plan)
{
  std::ostringstream csv = fixedText(4);
  csv << "room,area_m2,height_m,perimeter_m,doors,windows,x,y\n";
  for (std::size_t r = 0; r < plan.rooms.size(); ++r) {
    const PlanRoom& room = plan.rooms[r];
    csv << r + 1 << ',' << room.area << ',';
    if (room.ceiling > room.floor)
      csv << room.ceiling - room.floor;
    csv << ',' << perimeterOf(room) << ',' << countOpenings(room, true) << ',' << countOpenings(room, false) << ','
        << room.label.x() << ',' << room.label.y() << '\n';
  }
  return csv.str();
}
} // namespace fresco
