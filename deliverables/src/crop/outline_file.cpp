// SPDX-License-Identifier: BSD-3-Clause
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <fresco/core/require.h>
#include <fresco/deliverables/core/crop.h>
#include <fresco/io/file.h>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <stdexcept>
namespace fresco {
namespace {
using Outline = std::vector<Eigen::Vector2d>;

[[noreturn]] void fail(const std::string& reason) { throw std::runtime_error(reason); }

/// Rings are the innermost lists of points.
void addRings(const nlohmann::json& coordinates, int depth, std::vector<Outline>& outlines)
{
  if (depth > 2) // polygons, rings, points
    fail("GeoJSON: coordinates are nested too deep");
  if (!coordinates.at(0).at(0).is_number()) {
    for (const auto& part : coordinates)
      addRings(part, depth + 1, outlines);
    return;
  }
  Outline& outline = outlines.emplace_back();
  for (const auto& point : coordinates)
    outline.emplace_back(point.at(0).get<double>(), point.at(1).get<double>());
}

/// The polygons of a geometry, a feature or a collection of these.
void addPolygons(const nlohmann::json& value, int depth, std::vector<Outline>& outlines)
{
  if (depth > 100)
    fail("GeoJSON: nested too deep");
  const std::string type = value.is_object() ? value.value("type", "") : "";
  if (type == "Polygon" || type == "MultiPolygon")
    return addRings(value.at("coordinates"), 0, outlines);
  for (const auto& part : value)
    if (part.is_structured())
      addPolygons(part, depth + 1, outlines);
}

/// The corners of a path of straight lines: M L H V Z, or m l h v z relative to the point before.
void addPath(const std::string& text, std::vector<Outline>& outlines)
{
  Eigen::Vector2d at(0, 0), start(0, 0);
  std::vector<double> numbers; // that are not used yet
  char command = 0;
  bool open = false;
  for (const char *next = text.c_str(), *word = next; *next != 0; word = next) {
    if (const char letter = *next; std::isspace(letter) || letter == ',') {
      ++next;
      continue;
    } else if (std::isalpha(letter)) {
      if (std::strchr("MmLlHhVvZz", letter) == nullptr || !numbers.empty())
        fail("SVG: a path is not made of straight lines");
      command = letter;
      ++next;
      if (std::tolower(command) == 'z')
        at = start;
      continue;
    }
    char* end = nullptr;
    numbers.push_back(std::strtod(next, &end)); // stops where the next number begins without a space
    next = end;
    if (next == word)
      fail("SVG: a number is missing");
    const char kind = std::tolower(command);
    if (numbers.size() < (kind == 'h' || kind == 'v' ? 1 : 2))
      continue;
    const Eigen::Vector2d base = std::islower(command) ? at : Eigen::Vector2d(0, 0);
    if (kind != 'v')
      at.x() = base.x() + numbers.front();
    if (kind != 'h')
      at.y() = base.y() + numbers.back();
    numbers.clear();
    if (kind == 'm') {
      outlines.emplace_back();
      start = at;
      open = true;
      command = command == 'm' ? 'l' : 'L'; // further pairs are lines
    }
    if (!open || kind == 'z' || kind == 0)
      fail("SVG: a path does not begin with M");
    outlines.back().push_back(at);
  }
}

void addShape(const pugi::xml_node& node, std::vector<Outline>& outlines)
{
  for (pugi::xml_node at = node; at; at = at.parent())
    if (at.attribute("transform"))
      fail("SVG: what is drawn has a transform");
  const auto number = [&](const char* name) { return node.attribute(name).as_double(); };
  if (node.attribute("d"))
    addPath(node.attribute("d").value(), outlines);
  else if (node.attribute("points"))
    addPath(concat("M", node.attribute("points").value()), outlines);
  else
    addPath(
        concat("M", number("x"), ' ', number("y"), 'h', number("width"), 'v', number("height"), 'h', -number("width")),
        outlines);
}

std::vector<Outline> parseSvg(const std::string& content)
{
  pugi::xml_document document;
  if (const auto result = document.load_buffer(content.data(), content.size()); !result)
    fail(concat("SVG: ", result.description()));
  std::vector<Outline> outlines;
  for (const char* kind : {"polygon", "rect", "path"})
    for (const pugi::xpath_node& found : document.select_nodes(concat("//*[local-name()='", kind, "']").c_str()))
      addShape(found.node(), outlines);
  for (Outline& outline : outlines)
    for (Eigen::Vector2d& point : outline)
      point.y() = -point.y();
  return outlines;
}

std::vector<Outline> parseGeoJson(const std::string& content)
{
  std::vector<Outline> outlines;
  addPolygons(nlohmann::json::parse(content), 0, outlines);
  return outlines;
}

Eigen::Matrix2Xd closed(Outline outline)
{
  if (outline.size() > 1 && outline.front() == outline.back())
    outline.pop_back();
  return Eigen::Map<const Eigen::Matrix2Xd>(outline.empty() ? nullptr : outline[0].data(), 2, outline.size());
}
} // namespace

std::vector<Eigen::Matrix2Xd> readOutlines(const std::string& path)
{
  const std::string content = readFile(path);
  std::vector<Eigen::Matrix2Xd> outlines;
  try {
    for (const Outline& outline : extension(path) == ".svg" ? parseSvg(content) : parseGeoJson(content))
      outlines.push_back(closed(outline));
  } catch (const nlohmann::json::exception&) {
    throw std::runtime_error(path + ": is not GeoJSON");
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
  if (outlines.empty())
    throw std::runtime_error(path + ": draws no polygon");
  return outlines;
}
} // namespace fresco
